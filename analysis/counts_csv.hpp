#pragma once
#include <istream>
#include <string>

#include "analysis/confusion_matrix.hpp"
namespace tapstudy::analysis {
// A confusion matrix from comma-separated text. Lines that start with # are skipped. Two forms, told
// apart by the header:
//   stimulus,response[,…]                     one answer a line; further columns are not used
//   stimulus[,FACTOR…],RESPONSE,RESPONSE,…    one row a stimulus, counts below the responses; a
//     column that is not the name of a stimulus in the first column is a factor, its level below
// Throws InvalidInput with file:line if it is neither.
ConfusionMatrix read_counts(std::istream& text, const std::string& file);
}  // namespace tapstudy::analysis
