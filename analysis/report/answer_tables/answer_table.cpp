#include "analysis/report/answer_tables/answer_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "analysis/report/answer_tables/answer_columns.hpp"
#include "analysis/report/answer_tables/counts_csv.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
std::string without_spaces(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// A misspelt name would be one more stimulus, or one more participant.
void check_differ(const std::set<std::string>& names, const std::string& file) {
  std::vector<std::pair<std::string, std::string>> known;  // without spaces, and as given
  for (const std::string& name : names) {
    const std::string bare = without_spaces(name);
    const auto other = std::ranges::find_if(
        known, [&](const auto& each) { return is_same_word(each.first, bare); });
    if (other != known.end()) {
      throw core::InvalidInput{fmt::format("{}: '{}' and '{}' differ only in case or spaces", file,
                                           other->second, name)};
    }
    known.emplace_back(bare, name);
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
constexpr std::array missing_values{"", "NA", "None", "null", "NaN", "nan"};

bool is_missing(const std::string& cell) {
  return std::ranges::find(missing_values, cell) != missing_values.end();
}

// Where an answer was read.
struct Origin {
  const NamedCsv* csv{};
  int line{};
};
std::string to_text(const Origin& origin) {
  return origin.csv->text.place(origin.csv->file, origin.line);
}

// Reads one file.
class AnswerReader {
 public:
  AnswerReader(const NamedCsv& csv, const AnswerReading& reading)
      : csv_{csv},
        reading_{reading},
        places_{
            find_columns(header(), reading.columns, to_text({&csv, csv.text.rows.front().line}))} {
    for (const RowCondition& condition : reading.conditions) {
      const auto found = std::ranges::find(header(), condition.column);
      if (found == header().end()) {
        refuse(csv.text.rows.front().line,
               fmt::format("has no column '{}', which --where names", condition.column));
      }
      conditions_.emplace_back(static_cast<std::size_t>(found - header().begin()), condition.value);
    }
  }

  bool names_participants() const { return places_.participant.has_value(); }
  // To the table, with the origins of its answers.
  void add_to(AnswerTable& table, std::vector<Origin>& origins) const {
    for (const CsvRow& row : std::span{csv_.text.rows}.subspan(1)) {
      if (row.cells.size() != header().size()) {
        refuse(row.line,
               fmt::format("has {} cells, the header has {}", row.cells.size(), header().size()));
      }
      if (meets(conditions_, row)) {
        add(row, table, origins);
      }
    }
    table.possible_time = places_.possible_time;
    table.has_times |= places_.time.has_value();
  }

 private:
  using Conditions = std::vector<std::pair<std::size_t, std::string>>;  // place and value
  static bool meets(const Conditions& conditions, const CsvRow& row) {
    return std::ranges::all_of(conditions, [&](const auto& condition) {
      return row.cells[condition.first] == condition.second;
    });
  }
  void add(const CsvRow& row, AnswerTable& table, std::vector<Origin>& origins) const {
    ++table.rows;
    if (!meets(places_.counted, row)) {
      ++table.not_counted;
    } else if (is_missing(row.cells[places_.response])) {
      ++table.unanswered;
    } else {
      table.answers.push_back(answer_of(row));
      origins.push_back({&csv_, row.line});
    }
  }
  const std::vector<std::string>& header() const { return csv_.text.rows.front().cells; }
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw core::InvalidInput{fmt::format("{}: {}", to_text({&csv_, line}), what)};
  }

  results::AnswerRow answer_of(const CsvRow& row) const {
    results::AnswerRow answer;
    answer.mode = mode_of(row);
    answer.participant_id = places_.participant ? row.cells[*places_.participant]
                                                : std::filesystem::path{csv_.file}.stem().string();
    answer.stimulus = row.cells[places_.stimulus];
    const std::string& cell = row.cells[places_.response];
    if (is_missing(answer.stimulus) || is_missing(answer.participant_id)) {
      refuse(row.line,
             fmt::format("has an answer, '{}', but no {} (--where COLUMN=VALUE leaves rows out)",
                         cell, is_missing(answer.stimulus) ? "stimulus" : "participant"));
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
    const auto value = csv_.text.number(cell);
    if (!value || !(*value >= 0.0 && std::isfinite(*value))) {
      refuse(row.line, fmt::format("'{}' in column '{}' is not a time from 0", cell,
                                   header()[*places_.time]));
    }
    return *value * places_.time_unit_s;
  }

  const NamedCsv& csv_;
  const AnswerReading& reading_;
  AnswerPlaces places_;
  Conditions conditions_;
};

std::vector<Item> items_of(const std::set<std::string>& names) {
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

void check_responses(const std::vector<results::AnswerRow>& answers,
                     const std::vector<Origin>& origins, const std::set<std::string>& responses) {
  const std::unordered_set<std::string_view> known{responses.begin(), responses.end()};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::string& response = answers[i].response;
    if (!known.contains(response)) {
      throw core::InvalidInput{
          fmt::format("{}: response '{}' is not a stimulus (if it can be answered, name it with "
                      "--responses; if it stands for a stimulus, say --responses '{}=STIMULUS')",
                      to_text(origins[i]), response, response)};
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

AnswerTable read_answers(const std::vector<NamedCsv>& files, const AnswerReading& reading) {
  AnswerTable table;
  table.are_participants_known = files.size() > 1;
  std::vector<Origin> origins;
  std::size_t lines = 0;
  for (const NamedCsv& csv : files) {
    lines += csv.text.rows.size();
  }
  table.answers.reserve(lines);
  origins.reserve(lines);
  for (const NamedCsv& csv : files) {
    if (csv.text.rows.empty()) {
      throw core::InvalidInput{fmt::format("{}: is empty", csv.file)};
    }
    const AnswerReader reader{csv, reading};
    table.are_participants_known |= reader.names_participants();
    reader.add_to(table, origins);
  }
  if (table.answers.empty()) {
    throw core::InvalidInput{fmt::format("{}: holds no answers", files.front().file)};
  }
  keep_one_mode(table, origins);
  check_is_one_block(table.answers, origins);
  const std::set<std::string> stimuli = distinct(table.answers, &results::AnswerRow::stimulus);
  std::set<std::string> responses = stimuli;
  for (const auto& [given, meaning] : reading.responses) {
    responses.insert(meaning);
  }
  check_responses(table.answers, origins, responses);
  check_names(table.answers, files.front().file, stimuli, responses);
  table.stimuli = items_of(stimuli);
  table.responses = items_of(responses);
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
