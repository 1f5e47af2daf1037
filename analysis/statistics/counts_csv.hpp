#pragma once
#include <istream>
#include <string>

#include "analysis/statistics/confusion_matrix.hpp"
namespace tapstudy::analysis {
// A confusion matrix from comma-separated text (csv_rows.hpp). Two forms,
// told apart by the header:
//   stimulus,response[,…]                     one answer per line; further columns are ignored
//   stimulus[,FACTOR…],RESPONSE,RESPONSE,…    one row per stimulus, counts below the responses; the
//     columns before the first that is named like a stimulus are factors, with their levels below
// Throws InvalidInput with file:line if it is neither.
ConfusionMatrix read_counts(std::istream& text, const std::string& file);
}  // namespace tapstudy::analysis
