#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/answer_tables/answer_table.hpp"
#include "results/rows.hpp"
namespace tapstudy::analysis {
// What a row says beside its answer.
struct AnswerOrigin {
  const NamedCsv* csv{};
  const CsvRow* row{};
  std::optional<bool> is_said_right{};  // by the file itself
  std::string run{};                    // "date '2026-11-02', session '1'"; may be empty
  std::int64_t weight{1};               // how many answers it stands for
};
std::string to_text(const AnswerOrigin& origin);
using AnswerOrigins = std::vector<AnswerOrigin>;

// "1", "true", "correct" …, or the contrary; unset: says neither.
std::optional<bool> right_or_wrong(const std::string& cell);

// Names that read alike become the first of them, in answers and in `responses`; says which.
std::vector<std::string> merge_alike(std::vector<results::AnswerRow>& answers,
                                     std::map<std::string, std::string>& responses);

// Throws InvalidInput, with both figures, where the file's own column of right answers contradicts
// one of the names.
void check_right_answers(const std::vector<results::AnswerRow>& answers,
                         const AnswerOrigins& origins);

// The participants with several runs: several files, or values of the columns that tell runs apart,
// two answers each at least. Throws InvalidInput naming the runs, unless they are to be pooled.
std::vector<std::string> several_runs(const std::vector<results::AnswerRow>& answers,
                                      const AnswerOrigins& origins, bool pools_runs);
}  // namespace tapstudy::analysis
