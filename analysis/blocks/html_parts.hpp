#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// HTML elements shared by the block summaries.
std::string escaped(const std::string& text);
// A dot with its interval on a scale from 0 to 100 %, chance as a line.
std::string dot_plot(const Proportion& proportion, double chance);
void write_accuracy_row(std::ostream& out, const std::string& title, const Proportion& proportion,
                        double chance);
void write_hypotheses_html(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
