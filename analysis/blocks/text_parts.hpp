#pragma once
#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// Text elements shared by the block summaries.
inline constexpr std::size_t terminal_columns = 100;
// In characters of UTF-8, each as wide as any other.
std::size_t text_width(const std::string& text);
// The words in lines of at most terminal_columns behind so many spaces, the second and further
// lines two more; each ends with a line end. A longer word has a line of its own.
std::string wrapped(const std::string& text, std::size_t indent);
void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
