#pragma once
#include <string>
#include <vector>

#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/report/summary.hpp"
namespace tapstudy::runner {
// Reading options for a table from elsewhere.
struct TableOptions {
  analysis::AnswerColumns columns{};
  std::vector<std::string> conditions{};  // "COLUMN=VALUE"
  std::vector<std::string> responses{};   // "ANSWER" that is no stimulus, "GIVEN=ANSWER"
};

// The summary of a confusion matrix, or of answers one a row, whose participants are named by a
// column or by several files. Throws InvalidInput with file:line.
analysis::Summary summary_of_tables(const std::vector<std::string>& files,
                                    const TableOptions& options);
}  // namespace tapstudy::runner
