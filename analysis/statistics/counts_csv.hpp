#pragma once
#include <istream>
#include <string>
#include <vector>

#include "analysis/statistics/confusion_matrix.hpp"
namespace tapstudy::analysis {
// A confusion matrix from comma-separated text (csv_rows.hpp). Two forms,
// told apart by the header:
//   stimulus,response[,…]                     one answer per line; further columns are ignored
//   stimulus[,factor:NAME…],RESPONSE,RESPONSE,…   one row per stimulus, counts below the responses;
//     factors are marked, with their levels below
// A response in the first form that is no stimulus is refused unless it is one of
// `extra_responses`. Throws InvalidInput with file:line if it is neither.
struct CountsTable {
  ConfusionMatrix matrix;
  std::string mode;  // of the participants, where a comment says it: "# mode: simulated"
};
CountsTable read_counts(std::istream& text, const std::string& file,
                        const std::vector<std::string>& extra_responses = {});
inline constexpr const char* factor_mark = "factor:";
inline constexpr const char* mode_mark = "# mode: ";
}  // namespace tapstudy::analysis
