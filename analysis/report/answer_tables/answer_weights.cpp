#include "analysis/report/answer_tables/answer_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
bool is_counted_already(const std::vector<results::AnswerRow>& answers) {
  std::set<std::tuple<std::string_view, std::string_view, std::string_view>> kinds;
  return std::ranges::all_of(answers, [&](const results::AnswerRow& answer) {
    return kinds.emplace(answer.participant_id, answer.stimulus, answer.response).second;
  });
}

namespace {
using results::AnswerRow;
using Answers = std::vector<AnswerRow>;

[[noreturn]] void refuse_at(const AnswerOrigin& origin, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}: {}", to_text(origin), what)};
}

using Values = std::vector<double>;  // of a column, one an answer

std::optional<Values> numbers_in(const AnswerOrigins& origins, std::size_t place) {
  Values values;
  for (const AnswerOrigin& origin : origins) {
    const auto value = place < origin.row->cells.size()
                           ? origin.csv->text.number(origin.row->cells[place])
                           : std::nullopt;
    if (!value || !std::isfinite(*value) || *value < 0.0) {
      return std::nullopt;
    }
    values.push_back(*value);
  }
  return values;
}

// 0, 1, 2, … or 1, 2, 3, …: as rows and trials are counted.
bool count_rows(const Values& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != values.front() + static_cast<double>(i)) {
      return false;
    }
  }
  return values.front() <= 1.0;
}

// The same of each participant, in any order.
bool number_trials(const Answers& answers, const Values& values) {
  std::map<std::string_view, Values> of_people;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    of_people[answers[i].participant_id].push_back(values[i]);
  }
  return std::ranges::all_of(of_people, [](auto& person) {
    std::ranges::sort(person.second);
    return count_rows(person.second);
  });
}

bool are_whole(const Values& values) {
  return std::ranges::all_of(values, [](double value) { return value == std::floor(value); });
}

// Whether values have the same sum for each stimulus of each participant, 1 or 100 but for
// rounding: shares of its answers; or in all, where they are not whole. Single values tell nothing.
bool are_shares(const Answers& answers, const Values& values) {
  std::map<std::pair<std::string_view, std::string_view>, std::pair<double, int>> sums;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    auto& [sum, number] = sums[{answers[i].participant_id, answers[i].stimulus}];
    sum += values[i];
    ++number;
  }
  const auto is_near = [](double sum, double whole) {
    return std::abs(sum - whole) <= 0.011 * whole;
  };
  const auto all_near = [&](double whole) {
    return std::ranges::all_of(sums,
                               [&](const auto& one) { return is_near(one.second.first, whole); });
  };
  const double in_all = std::accumulate(values.begin(), values.end(), 0.0);
  if (!are_whole(values) && (is_near(in_all, 1.0) || is_near(in_all, 100.0))) {
    return true;
  }
  const bool are_several =
      std::ranges::any_of(sums, [](const auto& one) { return one.second.second > 1; });
  return sums.size() > 1 && are_several && (all_near(1.0) || all_near(100.0));
}

// Whether values of a column whose name does not say it may be counts: no flags, and nothing that a
// participant has (an age).
bool vary_as_counts(const Answers& answers, const Values& values) {
  std::map<std::string_view, double> of_people;
  bool varies = false;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    varies = varies ||
             of_people.emplace(answers[i].participant_id, values[i]).first->second != values[i];
  }
  return varies && std::ranges::max(values) > 1.0;
}

// Whether no two rows of a participant have one value, or they never fall: of numbers of trials,
// times and blocks. Counts do neither.
bool follow_rows(const Answers& answers, const Values& values) {
  std::map<std::string_view, Values> of_people;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    of_people[answers[i].participant_id].push_back(values[i]);
  }
  return std::ranges::all_of(of_people, [](auto& person) {
    Values& own = person.second;
    const bool never_falls = std::ranges::is_sorted(own);
    std::ranges::sort(own);
    return never_falls || std::ranges::adjacent_find(own) == own.end();
  });
}

// Every stimulus that a participant had several times was answered in another way each time: four
// times or more that is no chance, but a table in which each kind of answer has one row.
bool are_kinds(const Answers& answers) {
  constexpr std::size_t fewest = 4;
  std::set<std::pair<std::string_view, std::string_view>> presented;
  for (const AnswerRow& answer : answers) {
    presented.emplace(answer.participant_id, answer.stimulus);
  }
  return answers.size() >= presented.size() + fewest;
}

// Of a table that was counted no column is known to say how often.
void check_is_not_counted(const OtherColumns& columns, const Answers& answers,
                          const AnswerOrigins& origins) {
  for (const std::size_t place : columns.places) {
    const std::string& name = columns.header[place];
    const auto values = numbers_in(origins, place);
    const std::string column = described_column(columns.header, place);
    if (is_share(name) || (values && are_shares(answers, *values))) {
      refuse_at(origins.front(),
                fmt::format("{} holds shares, which are no counts: a table of answers needs how "
                            "often each was given (--weights names that column; --weights none: "
                            "each row is one answer)",
                            column));
    }
    if (values && are_whole(*values) && !number_trials(answers, *values) &&
        (may_be_counts(name) || (!(is_no_count(name) && follow_rows(answers, *values)) &&
                                 vary_as_counts(answers, *values)))) {
      refuse_at(origins.front(),
                fmt::format("{} may say how many answers a row stands for: {}, or --weights none "
                            "if each row is one answer",
                            column,
                            name.empty() ? "name it in the header and by --weights"
                                         : fmt::format("--weights '{}'", name)));
    }
  }
  if (are_kinds(answers)) {
    refuse_at(origins.front(),
              "each participant's answers to a stimulus differ from one another, as in a table "
              "that has one row for each kind of answer (counted, or averaged): --weights names "
              "the column that says how many there were, --weights none: each row is one answer");
  }
}

void check_are_not_counted(const std::vector<OtherColumns>& files, const Answers& answers,
                           const AnswerOrigins& origins) {
  if (answers.size() < 2 || !is_counted_already(answers)) {
    return;
  }
  for (const OtherColumns& file : files) {
    Answers of_file;
    AnswerOrigins their_origins;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (origins[i].csv == file.csv) {
        of_file.push_back(answers[i]);
        their_origins.push_back(origins[i]);
      }
    }
    if (!of_file.empty()) {
      check_is_not_counted(file, of_file, their_origins);
    }
  }
}

// That of the first file. Throws InvalidInput where only some have one.
std::string weight_column_of(const std::vector<OtherColumns>& files) {
  const auto is_weighted = [](const OtherColumns& file) { return !file.weight.empty(); };
  const auto weighted = std::ranges::find_if(files, is_weighted);
  const auto other = std::ranges::find_if_not(files, is_weighted);
  if (weighted != files.end() && other != files.end()) {
    throw core::InvalidInput{
        fmt::format("{}: has no column that says how many answers a row stands for, as '{}' of {} "
                    "does: --weights none if each row of all files is one answer",
                    other->csv->file, weighted->weight, weighted->csv->file)};
  }
  return files.front().weight;
}

// The column that rows are weighted by; empty: each is one answer. A trial's own number may be
// called n, too.
std::string weight_column(const std::string& named, const Answers& answers,
                          const AnswerOrigins& origins, const AnswerReading& reading) {
  if (named.empty() || !reading.columns.weight.empty()) {
    return named;
  }
  Values weights;
  for (const AnswerOrigin& origin : origins) {
    weights.push_back(static_cast<double>(origin.weight));
  }
  if (count_rows(weights) || !is_counted_already(answers)) {
    refuse_at(origins.front(),
              fmt::format("column '{0}' may say how many answers a row stands for: --weights {0}, "
                          "or --weights none if each row is one answer",
                          named));
  }
  return named;
}

void check_are_counts(const std::string& column, const Answers& answers,
                      const AnswerOrigins& origins) {
  Values weights;
  for (const AnswerOrigin& origin : origins) {
    weights.push_back(static_cast<double>(origin.weight));
  }
  if (is_share(column) || are_shares(answers, weights)) {
    refuse_at(origins.front(),
              fmt::format("column '{}' looks like shares in percent, which are no counts (answers "
                          "to each stimulus add up to 100, or it is called so): --weights names "
                          "another, --are-counts says that these are numbers of answers",
                          column));
  }
}

// Whose, to what, which.
using Kind = std::array<std::string, 3>;

// Throws InvalidInput where answers under one name are, kind by kind, the sum of all others': as
// R's addmargins and pandas' margins have it, they would count twice.
void check_no_name_sums_up(std::size_t field, const std::vector<Kind>& kinds,
                           const AnswerOrigins& origins) {
  std::map<std::string, std::map<Kind, std::int64_t>> of_names;
  std::map<Kind, std::int64_t> all;
  std::int64_t whole = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Kind others = kinds[i];
    others[field].clear();
    of_names[kinds[i][field]][others] += origins[i].weight;
    all[others] += origins[i].weight;
    whole += origins[i].weight;
  }
  constexpr std::size_t fewest = 3;  // of two that are equal neither is a sum
  if (of_names.size() < fewest || whole == 0) {
    return;
  }
  for (const auto& [name, counts] : of_names) {
    const bool is_sum = std::ranges::all_of(all, [&counts = counts](const auto& one) {
      const auto own = counts.find(one.first);
      return 2 * (own == counts.end() ? 0 : own->second) == one.second;
    });
    if (is_sum) {
      constexpr std::array fields{"participant", "stimulus", "answer"};
      const auto at = std::ranges::find_if(
          kinds, [&, &name = name](const Kind& kind) { return kind[field] == name; });
      refuse_at(origins[static_cast<std::size_t>(at - kinds.begin())],
                fmt::format("{} '{}' is the sum of the others: leave it out (--where "
                            "'COLUMN!={}'), or --are-counts says that it is none",
                            fields.at(field), name, name));
    }
  }
}

void check_has_no_sums(const Answers& answers, const AnswerOrigins& origins) {
  std::vector<Kind> kinds;
  for (const AnswerRow& answer : answers) {
    kinds.push_back({answer.participant_id, answer.stimulus, answer.response});
  }
  for (std::size_t field = 0; field < std::tuple_size_v<Kind>; ++field) {
    check_no_name_sums_up(field, kinds, origins);
  }
}

void repeat_by_weight(Answers& answers, AnswerOrigins& origins) {
  constexpr std::int64_t max_answers = 1'000'000;
  Answers all;
  AnswerOrigins their_origins;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (std::ssize(all) + origins[i].weight > max_answers) {
      refuse_at(origins[i], fmt::format("there are more than {} answers", max_answers));
    }
    const auto times = static_cast<std::size_t>(origins[i].weight);
    all.insert(all.end(), times, answers[i]);
    their_origins.insert(their_origins.end(), times, origins[i]);
  }
  answers = std::move(all);
  origins = std::move(their_origins);
}
}  // namespace

void weigh_answers(const std::vector<OtherColumns>& files, const AnswerReading& reading,
                   AnswerTable& table, AnswerOrigins& origins) {
  const std::string column =
      weight_column(weight_column_of(files), table.answers, origins, reading);
  if (column.empty()) {
    if (reading.columns.weight.empty()) {
      check_are_not_counted(files, table.answers, origins);
    }
    return;
  }
  if (!reading.are_counts) {
    check_are_counts(column, table.answers, origins);
    check_has_no_sums(table.answers, origins);
  }
  table.weight_column = column;
  table.has_times = false;  // of several answers there is at most a mean
  table.possible_time.clear();
  for (AnswerRow& answer : table.answers) {
    answer.response_time_s = std::numeric_limits<double>::quiet_NaN();
  }
  repeat_by_weight(table.answers, origins);
  if (table.answers.empty()) {
    throw core::InvalidInput{"the weights of all answers are 0"};
  }
}
}  // namespace tapstudy::analysis
