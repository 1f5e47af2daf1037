#pragma once
#include <set>
#include <string>
#include <vector>

#include "results/rows.hpp"
namespace tapstudy::analysis {
// The values of one column. Neighbours are mostly equal.
std::set<std::string> distinct(const std::vector<results::AnswerRow>& answers,
                               std::string results::AnswerRow::*column);

// Throws InvalidInput, with the file, where two stimuli, responses or participants differ only in
// case or spaces, and where no answer names a stimulus.
void check_names(const std::vector<results::AnswerRow>& answers, const std::string& file,
                 const std::set<std::string>& stimuli, const std::set<std::string>& responses);
}  // namespace tapstudy::analysis
