#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/summary.hpp"
namespace tapstudy::runner {
// Reading options for a table from elsewhere.
struct TableOptions {
  analysis::AnswerColumns columns{};
  std::vector<std::string> conditions{};  // "COLUMN=VALUE"
  std::vector<std::string> responses{};   // "ANSWER" that is no stimulus, "GIVEN=ANSWER"
  std::vector<std::string> order{};       // of stimuli and responses
  std::string encoding{};                 // as iconv calls it; empty: UTF-8
  bool merges_alike{false};
  bool pools_runs{false};
  bool pools_tasks{false};
  bool counts_practice{false};
  bool are_counts{false};                      // also what looks like percentages or sums
  std::optional<analysis::MatrixRows> rows{};  // of a matrix whose corner does not say it
};

// The summary of a confusion matrix, or of answers one a row, whose participants are named by a
// column or by several files. Throws InvalidInput with file:line.
analysis::Summary summary_of_tables(const std::vector<std::string>& files,
                                    const TableOptions& options);
}  // namespace tapstudy::runner
