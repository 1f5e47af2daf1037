#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
namespace tapstudy::analysis {
// HTML elements shared by the block summaries.
std::string escaped(const std::string& text);
// The same, where a number is not parted from its sign or its unit: with minus signs, and spaces
// that do not break.
std::string escaped_numbers(const std::string& text);
// A dot with its interval on a scale from 0 to 100 %, chance as a line; `alternative` says the
// same.
std::string dot_plot(double share, const Interval& interval, double chance,
                     const std::string& alternative);
// The same with the score interval of the proportion; empty without trials.
std::string dot_plot(const Proportion& proportion, double chance);
void write_accuracy_row(std::ostream& out, const std::string& title, const Proportion& proportion,
                        double chance);
void write_dot_row(std::ostream& out, const std::string& title, const std::string& words,
                   const std::string& dots);
void write_hypotheses_html(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);
}  // namespace tapstudy::analysis
