#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/statistics/csv_rows.hpp"
namespace tapstudy::analysis {
// Which columns of a table of answers hold what. Empty: those of the table's format.
struct AnswerColumns {
  std::string stimulus{};
  std::string response{};
  std::string participant{};  // `no_column`: not known
  std::string time{};
  double time_unit_s{};   // 0: the format's
  std::string weight{};   // how many answers a row stands for; `no_column`: one
  std::string correct{};  // whether the file takes the answer for right; `no_column`: not looked at
  bool are_given() const {
    return !(stimulus.empty() && response.empty() && participant.empty() && time.empty() &&
             weight.empty() && correct.empty());
  }
};

inline constexpr const char* no_column = "none";
inline constexpr const char* run_of_file = "run of the file";

// A column and the value that it must have, or must not.
struct RowCondition {
  std::string column;
  std::string value;
  bool is_excluded{false};  // rows with that value are left out, not those without
};

// The same, of the column at that place in a row, from 0.
struct PlacedCondition {
  std::size_t place{};
  std::string value;
  bool is_excluded{false};
  bool is_met_by(const CsvRow& row) const { return (row.cells[place] == value) != is_excluded; }
};

// Their places in a row, from 0.
struct AnswerPlaces {
  std::size_t stimulus{};
  std::size_t response{};
  std::optional<std::size_t> participant{};
  std::optional<std::size_t> time{};
  std::optional<std::size_t> mode{};  // as tapstudy exports it: real, pilot or simulated
  double time_unit_s{1.0};
  // Of tapstudy's own exports: what a row that counts holds (no practice, no catch trial, …), and
  // the block, of which there must be one.
  std::vector<PlacedCondition> counted{};
  std::optional<std::size_t> block{};
  std::string possible_time{};  // a column that may hold times, of an unknown unit; empty: none
  std::optional<std::size_t> weight{};  // as chosen, or by its name
  std::optional<std::size_t> correct{};
  // By their names they tell runs of one participant apart.
  std::vector<std::size_t> runs{};
  bool is_own_export{};
};

// Whether a cell says that there is no answer: "", "NA", "timeout", …
bool is_missing(const std::string& cell);
// Whether a column of that name holds shares, which are no counts.
bool is_share(const std::string& name);
// Whether a column of that name may hold counts: "count_nonzero", "Anzahl", "0" and no name at all,
// as pandas calls sizes of groups.
bool may_be_counts(const std::string& name);
// Whether it is called after something else: numbers of trials, times, …
bool is_no_count(const std::string& name);
// "column 'n'", or by its place where it has no name.
std::string described_column(const std::vector<std::string>& header, std::size_t place);

// Formats are told apart by columns that no other has: tapstudy's own exports, PsychoPy's wide CSV
// (answers are keys of the one keyboard component), jsPsych's CSV (times in milliseconds), and any
// table with columns `stimulus` and `response`. Throws InvalidInput with `where` if a column that
// is named is missing or there twice, if several could hold the answers, and if participants are
// not known but a column's name says that it may tell them.
AnswerPlaces find_columns(const std::vector<std::string>& header, const AnswerColumns& chosen,
                          const std::string& where);
// Whatever the case of their letters.
bool is_same_word(std::string_view one, std::string_view other);
// Whether the header is that of a table of answers, as far as its names say.
bool has_answers(const std::vector<std::string>& header);
}  // namespace tapstudy::analysis
