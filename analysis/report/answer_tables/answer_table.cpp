#include "analysis/report/answer_tables/answer_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "analysis/report/answer_tables/answer_checks.hpp"
#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/report/answer_tables/answer_weights.hpp"
#include "analysis/report/answer_tables/column_words.hpp"
#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/answer_tables/foreign_text.hpp"
#include "analysis/report/answer_tables/other_columns.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
// A misspelt name would be one more stimulus, or one more participant.
void check_differ(const std::set<std::string>& names, const std::string& file) {
  if (const auto alike = first_alike({names.begin(), names.end()})) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' and '{}' read alike (they differ in case, spaces, dashes, zeros of "
                    "numbers, how letters are composed, marks that are not seen, or letters of "
                    "another alphabet): --merge-alike makes them one",
                    file, alike->first, alike->second)};
  }
}
}  // namespace

std::set<std::string> distinct(const std::vector<results::AnswerRow>& answers,
                               std::string results::AnswerRow::*column) {
  std::unordered_set<std::string_view> found;
  std::string_view last;
  for (const results::AnswerRow& answer : answers) {
    if (found.empty() || answer.*column != last) {
      last = answer.*column;
      found.insert(last);
    }
  }
  return {found.begin(), found.end()};
}

void check_names(const std::vector<results::AnswerRow>& answers, const std::string& file,
                 const std::set<std::string>& stimuli, const std::set<std::string>& responses) {
  check_differ(responses, file);
  check_differ(distinct(answers, &results::AnswerRow::participant_id), file);
  if (std::ranges::none_of(answers, [&](const results::AnswerRow& answer) {
        return stimuli.contains(answer.response);
      })) {
    throw core::InvalidInput{
        fmt::format("{}: no answer names a stimulus (answers: '{}' and others; stimuli: {}): say "
                    "what answers stand for by --responses GIVEN=STIMULUS",
                    file, answers.front().response, fmt::join(stimuli, ", "))};
  }
}

namespace {
using Origin = AnswerOrigin;

// Reads one file.
class AnswerReader {
 public:
  AnswerReader(const NamedCsv& csv, const AnswerReading& reading)
      : csv_{csv},
        reading_{reading},
        places_{find_columns(header(), reading.columns, to_text({&csv, &csv.text.rows.front()}))} {
    for (const RowCondition& condition : reading.conditions) {
      const auto found = std::ranges::find(header(), condition.column);
      if (std::ranges::count(header(), condition.column) != 1) {
        refuse(csv.text.rows.front(),
               fmt::format("has {} '{}', which --where names",
                           found == header().end() ? "no column" : "several columns",
                           condition.column));
      }
      conditions_.push_back({static_cast<std::size_t>(found - header().begin()), condition.value,
                             condition.is_excluded});
    }
    find_runs();
    // others hold something else: a share of right answers, the right answer itself
    if (places_.correct && !says_what_is_right(*places_.correct)) {
      not_compared_ = places_.correct;
      places_.correct.reset();
    }
  }

  bool names_participants() const { return places_.participant.has_value(); }
  // To the table, with the origins of its answers.
  void add_to(AnswerTable& table, std::vector<Origin>& origins) const {
    for (const CsvRow& row : std::span{csv_.text.rows}.subspan(1)) {
      if (row.cells.size() != header().size()) {
        refuse(row,
               fmt::format("has {} cells, the header has {}", row.cells.size(), header().size()));
      }
      if (meets(conditions_, row)) {
        add(row, table, origins);
      }
    }
    if (!reading_.counts_practice && !places_.is_own_export) {
      check_holds_no_practice();
    }
    if (not_compared_) {
      table.not_compared.insert(header()[*not_compared_]);
    }
    table.possible_time = places_.possible_time;
    table.has_times |= places_.time.has_value();
  }
  OtherColumns other_columns() const {
    OtherColumns other{&csv_,
                       header(),
                       {},
                       places_.weight ? header()[*places_.weight] : "",
                       header()[places_.response],
                       places_.time || !places_.possible_time.empty()};
    std::set<std::optional<std::size_t>> known{places_.stimulus,    places_.response,
                                               places_.participant, places_.time,
                                               places_.mode,        places_.block};
    known.insert(places_.runs.begin(), places_.runs.end());
    for (std::size_t place = 0; place < header().size() && !places_.is_own_export; ++place) {
      if (!known.contains(place) && place != places_.correct) {
        other.places.push_back(place);
      }
    }
    return other;
  }

 private:
  using Conditions = std::vector<PlacedCondition>;
  static bool meets(const Conditions& conditions, const CsvRow& row) {
    return std::ranges::all_of(
        conditions, [&](const PlacedCondition& condition) { return condition.is_met_by(row); });
  }
  // Columns that tell runs of one participant apart by their names, or have dates, but for what
  // changes from row to row.
  void find_runs() {
    for (std::size_t place = 0; place < header().size() && !places_.is_own_export; ++place) {
      if (place == places_.stimulus || place == places_.response || place == places_.participant ||
          std::ranges::find(places_.runs, place) != places_.runs.end()) {
        continue;
      }
      if (tells_runs(header()[place]) || all_in(place, looks_like_date)) {
        places_.runs.push_back(place);
      }
    }
    std::erase_if(places_.runs, [&](std::size_t place) { return changes_often(place); });
  }
  bool all_in(std::size_t place, bool (*is_so)(const std::string& cell)) const {
    const auto rows = std::span{csv_.text.rows}.subspan(1);
    return !rows.empty() && std::ranges::all_of(rows, [&](const CsvRow& row) {
      return row.cells.size() == header().size() && is_so(row.cells[place]);
    });
  }
  bool changes_often(std::size_t place) const {
    std::set<std::string_view> values;
    for (const CsvRow& row : std::span{csv_.text.rows}.subspan(1)) {
      if (row.cells.size() == header().size()) {  // else it is refused at its line
        values.insert(row.cells[place]);
      }
    }
    return 2 * values.size() > csv_.text.rows.size() - 1;
  }
  bool says_what_is_right(std::size_t place) const {
    return std::ranges::all_of(std::span{csv_.text.rows}.subspan(1), [&](const CsvRow& row) {
      const std::string& cell = row.cells.size() == header().size() ? row.cells[place] : "";
      return is_missing(cell) || right_or_wrong(cell);
    });
  }
  std::vector<const CsvRow*> chosen_rows() const {
    std::vector<const CsvRow*> rows;
    for (const CsvRow& row : std::span{csv_.text.rows}.subspan(1)) {
      if (meets(conditions_, row)) {
        rows.push_back(&row);
      }
    }
    return rows;
  }
  // Where a column says that some of the rows are practice, it is for the user to say whether they
  // count.
  void check_holds_no_practice() const {
    const std::vector<const CsvRow*> rows = chosen_rows();
    for (std::size_t column = 0; column < header().size(); ++column) {
      if (column != places_.stimulus && column != places_.response &&
          column != places_.participant) {
        check_holds_no_practice(rows, column);
      }
    }
  }
  void check_holds_no_practice(const std::vector<const CsvRow*>& rows, std::size_t column) const {
    const std::string& name = header()[column];
    std::unordered_map<std::string_view, bool> known;  // by the cell
    const auto is_practice = [&](const CsvRow* row) {
      const std::string& cell = row->cells[column];
      const auto [found, is_new] = known.try_emplace(cell, false);
      found->second = is_new ? says_uncounted(name, cell) : found->second;
      return found->second;
    };
    const auto practice = std::ranges::count_if(rows, is_practice);
    // all rows of a file may be of somebody who does not count
    const bool is_chosen =
        std::ranges::find(conditions_, column, &PlacedCondition::place) != conditions_.end();
    if (practice > 0 && (practice < std::ssize(rows) || (is_of_states(name) && !is_chosen))) {
      const CsvRow& first = **std::ranges::find_if(rows, is_practice);
      std::set<std::string_view> counted;
      std::set<std::string_view> left_out;
      for (const CsvRow* const row : rows) {
        (is_practice(row) ? left_out : counted).insert(row->cells[column]);
      }
      refuse(first, fmt::format("column '{}' says '{}': {} of {} rows are practice, or not to be "
                                "counted. Leave them out ({}), or --count-practice",
                                name, first.cells[column], practice, rows.size(),
                                conditions_for(name, counted, left_out)));
    }
  }
  // What leaves out the rows with some values of a column, and no others.
  static std::string conditions_for(const std::string& column,
                                    const std::set<std::string_view>& counted,
                                    const std::set<std::string_view>& left_out) {
    if (counted.size() == 1 && left_out.size() > 1) {
      return fmt::format("--where '{}={}'", column, *counted.begin());
    }
    std::vector<std::string> conditions;
    for (const std::string_view value : left_out) {
      conditions.push_back(fmt::format("--where '{}!={}'", column, value));
    }
    return fmt::format("{}", fmt::join(conditions, " "));
  }
  void add(const CsvRow& row, AnswerTable& table, std::vector<Origin>& origins) const {
    ++table.rows;
    if (!meets(places_.counted, row)) {
      ++table.not_counted;
    } else if (is_unanswered(row.cells[places_.response])) {
      ++table.unanswered[row.cells[places_.response]];
    } else {
      table.answers.push_back(answer_of(row));
      origins.push_back(
          {&csv_, &row,
           places_.correct ? right_or_wrong(row.cells[*places_.correct]) : std::nullopt,
           run_of(row), places_.weight ? weight_of(row) : 1});
    }
  }
  bool is_unanswered(const std::string& cell) const {
    return is_missing(cell) && !reading_.responses.contains(cell);
  }
  std::string run_of(const CsvRow& row) const {
    std::vector<std::string> parts;
    for (const std::size_t place : places_.runs) {
      parts.push_back(fmt::format("{} '{}'", header()[place], row.cells[place]));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  }
  std::int64_t weight_of(const CsvRow& row) const {
    constexpr std::int64_t max_weight = 1'000'000;
    const std::string& cell = row.cells[*places_.weight];
    const auto weight = count_in_cell(csv_.text, cell);
    if (!weight || *weight > max_weight) {
      refuse(row, fmt::format("'{}' in column '{}' is not a count of answers (from 0 to {}; "
                              "shares are no counts; --weights none: each row is one answer)",
                              cell, header()[*places_.weight], max_weight));
    }
    return *weight;
  }
  const std::vector<std::string>& header() const { return csv_.text.rows.front().cells; }
  [[noreturn]] void refuse(const CsvRow& row, const std::string& what) const {
    throw core::InvalidInput{fmt::format("{}: {}", to_text({&csv_, &row}), what)};
  }

  results::AnswerRow answer_of(const CsvRow& row) const {
    results::AnswerRow answer;
    answer.mode = mode_of(row);
    answer.participant_id = places_.participant ? row.cells[*places_.participant]
                                                : std::filesystem::path{csv_.file}.stem().string();
    answer.stimulus = row.cells[places_.stimulus];
    const std::string cell = only_answer_in(row.cells[places_.response]);
    if (is_unanswered(answer.stimulus)) {
      refuse(row, fmt::format("has an answer, '{0}', but no stimulus (--where '{2}!={1}' leaves "
                              "such rows out; --responses '{1}' says that it is a name)",
                              cell, answer.stimulus, header()[places_.stimulus]));
    }
    if (is_missing(answer.participant_id)) {
      refuse(row, fmt::format("has an answer, '{}', but no participant (--where COLUMN!=VALUE "
                              "leaves rows out; --participant-column none: they are not known)",
                              cell));
    }
    answer.block = places_.block ? row.cells[*places_.block] : "";
    const auto meaning = reading_.responses.find(cell);
    answer.response = meaning == reading_.responses.end() ? cell : meaning->second;
    answer.is_correct = answer.response == answer.stimulus;
    answer.response_time_s = time_of(row);
    return answer;
  }
  // Somebody else's column of that name means something else.
  results::Mode mode_of(const CsvRow& row) const {
    for (const results::Mode mode : {results::Mode::pilot, results::Mode::simulated}) {
      if (places_.mode && row.cells[*places_.mode] == results::to_text(mode)) {
        return mode;
      }
    }
    return results::Mode::real;
  }
  double time_of(const CsvRow& row) const {
    if (!places_.time || is_missing(row.cells[*places_.time])) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const std::string& cell = row.cells[*places_.time];
    auto value = csv_.text.number(cell);
    if (const std::size_t comma = cell.find(','); !value && comma != std::string::npos) {
      value = core::number_in<double>(std::string{cell}.replace(comma, 1, "."));  // in quotes
    }
    if (!value || !(*value >= 0.0 && std::isfinite(*value))) {
      refuse(row, fmt::format("'{}' in column '{}' is not a time from 0", cell,
                              header()[*places_.time]));
    }
    return *value * places_.time_unit_s;
  }

  const NamedCsv& csv_;
  const AnswerReading& reading_;
  AnswerPlaces places_;
  Conditions conditions_;
  std::optional<std::size_t> not_compared_{};  // a column called after right answers
};

std::vector<Item> items_of(const std::vector<std::string>& names) {
  std::vector<Item> items;
  for (const std::string& name : names) {
    items.push_back({name, name, {}});
  }
  return items;
}

// Which number each trial has for its participant, and each presentation of a stimulus.
void count_on(std::vector<results::AnswerRow>& answers) {
  struct Counts {
    int index{};
    int trials{};
    std::unordered_map<std::string, int> presented;  // of each stimulus
  };
  std::unordered_map<std::string, Counts> people;
  std::int64_t id = 0;
  for (results::AnswerRow& answer : answers) {
    const auto index = static_cast<int>(people.size());
    Counts& person = people.try_emplace(answer.participant_id, Counts{index, 0, {}}).first->second;
    answer.trial_id = ++id;
    answer.place_in_block = person.trials;
    answer.number = ++person.trials;
    answer.repetition = ++person.presented[answer.stimulus];
    answer.participant_index = person.index;
  }
}

std::string why_no_answer(const std::string& response, const std::string& column,
                          const std::set<std::string>& responses) {
  const auto like = std::ranges::find_if(responses, [&](const std::string& name) {
    return first_alike({name, response}).has_value();
  });
  return fmt::format(
      "response '{0}' is not a stimulus (if it can be answered, name it with --responses; if it "
      "stands for a stimulus, say --responses '{0}=STIMULUS'; if it is none, --where "
      "'{1}!={0}'{2})",
      response, column,
      like == responses.end() ? "" : fmt::format("; it reads like '{}': --merge-alike", *like));
}

void check_responses(const std::vector<results::AnswerRow>& answers,
                     const std::vector<Origin>& origins, const std::string& column,
                     const std::set<std::string>& responses) {
  const std::unordered_set<std::string_view> known{responses.begin(), responses.end()};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::string& response = answers[i].response;
    if (!known.contains(response)) {
      throw core::InvalidInput{
          fmt::format("{}: {}", to_text(origins[i]), why_no_answer(response, column, responses))};
    }
  }
  if (responses.size() > max_classes) {
    throw core::InvalidInput{
        fmt::format("{}: names {} different stimuli and responses (at most {})",
                    to_text(origins.front()), responses.size(), max_classes)};
  }
}

// As a study's own report: real participants, or else pilots, or else simulated ones.
void keep_one_mode(AnswerTable& table, std::vector<Origin>& origins) {
  const auto first = std::ranges::min_element(table.answers, {}, &results::AnswerRow::mode);
  if (first == table.answers.end()) {
    return;
  }
  const results::Mode mode = first->mode;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < table.answers.size(); ++i) {
    if (table.answers[i].mode == mode) {
      if (kept != i) {
        table.answers[kept] = std::move(table.answers[i]);
        origins[kept] = origins[i];
      }
      ++kept;
    }
  }
  table.of_other_modes = table.answers.size() - kept;
  table.answers.resize(kept);
  origins.resize(kept);
}

void check_is_one_block(const std::vector<results::AnswerRow>& answers,
                        const std::vector<Origin>& origins) {
  const auto other = std::ranges::find_if(answers, [&](const results::AnswerRow& answer) {
    return answer.block != answers.front().block;
  });
  if (other != answers.end()) {
    throw core::InvalidInput{
        fmt::format("{}: is of block '{}', others are of '{}': name one by --where block={}",
                    to_text(origins[static_cast<std::size_t>(other - answers.begin())]),
                    other->block, answers.front().block, answers.front().block)};
  }
}
}  // namespace

namespace {
// Each once, as they first appear.
std::vector<std::string> by_appearance(const std::vector<results::AnswerRow>& answers,
                                       std::string results::AnswerRow::*column,
                                       std::vector<std::string> names = {}) {
  std::unordered_set<std::string> known{names.begin(), names.end()};
  for (const results::AnswerRow& answer : answers) {
    if (known.insert(answer.*column).second) {
      names.push_back(answer.*column);
    }
  }
  return names;
}

// Throws InvalidInput for a name that is none and where one is missing.
std::vector<std::string> in_order(std::vector<std::string> names,
                                  const std::vector<std::string>& order) {
  if (order.empty()) {
    return names;
  }
  const auto place_of = [&](const std::string& name) {
    return std::ranges::find(order, name) - order.begin();
  };
  const auto missing = std::ranges::find_if(
      names, [&](const std::string& name) { return place_of(name) == std::ssize(order); });
  if (missing != names.end()) {
    throw core::InvalidInput{fmt::format("--order: lacks '{}'", *missing)};
  }
  std::ranges::sort(names, {}, place_of);
  return names;
}

void check_order_names(const std::vector<std::string>& order,
                       const std::set<std::string>& responses) {
  for (const std::string& name : order) {
    if (!responses.contains(name)) {
      throw core::InvalidInput{
          fmt::format("--order: '{}' is no stimulus and no answer (there are {})", name,
                      fmt::join(responses, ", "))};
    }
  }
}

// Rows of all files, of one mode and one block.
struct ReadRows {
  std::vector<Origin> origins;
  std::vector<OtherColumns> columns;  // of each file
};

// Where no row meets all conditions.
std::string why_none_is_chosen(const std::vector<NamedCsv>& files,
                               const std::vector<RowCondition>& conditions) {
  std::vector<std::string> named;
  for (const RowCondition& condition : conditions) {
    named.push_back(fmt::format("--where '{}{}={}'", condition.column,
                                condition.is_excluded ? "!" : "", condition.value));
    const bool is_met = std::ranges::any_of(files, [&](const NamedCsv& csv) {
      const std::vector<std::string>& header = csv.text.rows.front().cells;
      const auto place = std::ranges::find(header, condition.column) - header.begin();
      const PlacedCondition placed{static_cast<std::size_t>(place), condition.value,
                                   condition.is_excluded};
      return std::ranges::any_of(std::span{csv.text.rows}.subspan(1),
                                 [&](const CsvRow& row) { return placed.is_met_by(row); });
    });
    if (!is_met) {
      return ": no row meets " + named.back();
    }
  }
  return fmt::format(
      ": each condition is met by some rows, and {} by none (of several values of one column keep "
      "those that are wanted by leaving the others out: COLUMN!=VALUE)",
      fmt::join(named, " and "));
}

ReadRows read_rows(const std::vector<NamedCsv>& files, const AnswerReading& reading,
                   AnswerTable& table) {
  ReadRows read;
  std::size_t lines = 0;
  for (const NamedCsv& csv : files) {
    lines += csv.text.rows.size();
  }
  table.answers.reserve(lines);
  read.origins.reserve(lines);
  for (const NamedCsv& csv : files) {
    if (csv.text.rows.empty()) {
      throw core::InvalidInput{fmt::format("{}: is empty", csv.file)};
    }
    const AnswerReader reader{csv, reading};
    table.are_participants_known = reader.names_participants() ||
                                   (files.size() > 1 && reading.columns.participant != no_column);
    reader.add_to(table, read.origins);
    read.columns.push_back(reader.other_columns());
  }
  if (table.answers.empty()) {
    throw core::InvalidInput{fmt::format("{}: holds no answers{}", files.front().file,
                                         table.rows == 0 && !reading.conditions.empty()
                                             ? why_none_is_chosen(files, reading.conditions)
                                             : "")};
  }
  keep_one_mode(table, read.origins);
  check_is_one_block(table.answers, read.origins);
  return read;
}
}  // namespace

AnswerTable read_answers(const std::vector<NamedCsv>& files, const AnswerReading& reading) {
  AnswerTable table;
  ReadRows read = read_rows(files, reading, table);
  std::map<std::string, std::string> meanings = reading.responses;
  if (reading.merges_alike) {
    table.merged = merge_alike(table.answers, meanings);
  }
  const std::set<std::string> stimuli = distinct(table.answers, &results::AnswerRow::stimulus);
  std::set<std::string> responses = stimuli;
  for (const auto& [given, meaning] : meanings) {
    responses.insert(meaning);
  }
  check_responses(table.answers, read.origins, read.columns.back().response, responses);
  check_names(table.answers, files.front().file, stimuli, responses);
  check_right_answers(table.answers, read.origins);
  check_other_columns(read.columns, table.answers, read.origins, reading,
                      table.are_participants_known);
  if (table.are_participants_known) {
    table.pooled = several_runs(table.answers, read.origins, reading.pools_runs);
  }
  weigh_answers(read.columns, reading, table, read.origins);
  check_order_names(reading.order, responses);
  std::vector<std::string> in_appearance =
      by_appearance(table.answers, &results::AnswerRow::stimulus);
  table.stimuli = items_of(in_order(in_appearance, reading.order));
  in_appearance =
      by_appearance(table.answers, &results::AnswerRow::response, std::move(in_appearance));
  std::ranges::copy_if(responses, std::back_inserter(in_appearance), [&](const std::string& name) {
    return std::ranges::find(in_appearance, name) == in_appearance.end();
  });
  table.responses = items_of(in_order(std::move(in_appearance), reading.order));
  for (Item& response : table.responses) {
    response.is_alternative = stimuli.contains(response.name);
  }
  for (const results::AnswerRow& answer : table.answers) {
    if (answer.mode != results::Mode::real) {
      table.modes.insert(results::to_text(answer.mode));
    }
  }
  count_on(table.answers);
  return table;
}
}  // namespace tapstudy::analysis
