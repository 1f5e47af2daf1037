#include "analysis/answer_tables/answer_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t max_classes = 200;
constexpr std::array missing_values{"", "NA", "None", "null"};

bool is_missing(const std::string& cell) {
  return std::ranges::find(missing_values, cell) != missing_values.end();
}

// An answer and where it was read.
struct ReadAnswer {
  results::AnswerRow row;
  std::string where;
};

// Reads one file.
class AnswerReader {
 public:
  AnswerReader(const NamedCsv& csv, const AnswerReading& reading)
      : csv_{csv},
        reading_{reading},
        places_{find_columns(header(), reading.columns, where(csv.text.rows.front().line))} {
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
  // A row without an answer has an empty response.
  std::vector<ReadAnswer> answers() const {
    std::vector<ReadAnswer> found;
    for (const CsvRow& row : std::span{csv_.text.rows}.subspan(1)) {
      if (row.cells.size() != header().size()) {
        refuse(row.line,
               fmt::format("has {} cells, the header has {}", row.cells.size(), header().size()));
      }
      if (std::ranges::all_of(conditions_, [&](const auto& condition) {
            return row.cells[condition.first] == condition.second;
          })) {
        found.push_back({answer_of(row), where(row.line)});
      }
    }
    return found;
  }

 private:
  const std::vector<std::string>& header() const { return csv_.text.rows.front().cells; }
  std::string where(int line) const { return fmt::format("{}:{}", csv_.file, line); }
  [[noreturn]] void refuse(int line, const std::string& what) const {
    throw core::InvalidInput{fmt::format("{}: {}", where(line), what)};
  }

  results::AnswerRow answer_of(const CsvRow& row) const {
    results::AnswerRow answer;
    answer.mode = mode_of(row);
    answer.participant_id = places_.participant ? row.cells[*places_.participant]
                                                : std::filesystem::path{csv_.file}.stem().string();
    answer.stimulus = row.cells[places_.stimulus];
    const std::string& cell = row.cells[places_.response];
    if (is_missing(cell)) {
      return answer;
    }
    if (answer.stimulus.empty() || answer.participant_id.empty()) {
      refuse(row.line, fmt::format("has an answer, '{}', but no {}", cell,
                                   answer.stimulus.empty() ? "stimulus" : "participant"));
    }
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
    const auto value = core::number_in<double>(cell);
    if (!value || !(*value >= 0.0 && std::isfinite(*value))) {
      refuse(row.line, fmt::format("'{}' in column '{}' is not a time from 0", cell,
                                   header()[*places_.time]));
    }
    return *value * places_.time_unit_s;
  }

  const NamedCsv& csv_;
  const AnswerReading& reading_;
  AnswerPlaces places_;
  std::vector<std::pair<std::size_t, std::string>> conditions_;
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
  std::map<std::string, std::map<std::string, int>> presented;
  std::map<std::string, int> trials;
  std::map<std::string, int> indices;
  std::int64_t id = 0;
  for (results::AnswerRow& answer : answers) {
    const std::string& person = answer.participant_id;
    answer.trial_id = ++id;
    answer.number = ++trials[person];
    answer.repetition = ++presented[person][answer.stimulus];
    answer.participant_index =
        indices.try_emplace(person, static_cast<int>(indices.size())).first->second;
  }
}

void check_responses(const std::vector<ReadAnswer>& answers,
                     const std::set<std::string>& responses) {
  for (const ReadAnswer& answer : answers) {
    if (!responses.contains(answer.row.response)) {
      throw core::InvalidInput{fmt::format(
          "{}: response '{}' is no stimulus (if it can be answered, name it with --responses; if "
          "it stands for a stimulus, say --responses '{}=STIMULUS')",
          answer.where, answer.row.response, answer.row.response)};
    }
  }
  if (responses.size() > max_classes) {
    throw core::InvalidInput{
        fmt::format("{}: names {} different stimuli and responses (at most {})",
                    answers.front().where, responses.size(), max_classes)};
  }
}
}  // namespace

AnswerTable read_answers(const std::vector<NamedCsv>& files, const AnswerReading& reading) {
  AnswerTable table;
  table.are_participants_known = files.size() > 1;
  std::vector<ReadAnswer> answers;
  for (const NamedCsv& csv : files) {
    if (csv.text.rows.empty()) {
      throw core::InvalidInput{fmt::format("{}: is empty", csv.file)};
    }
    const AnswerReader reader{csv, reading};
    table.are_participants_known |= reader.names_participants();
    for (ReadAnswer& answer : reader.answers()) {
      answers.push_back(std::move(answer));
    }
  }
  table.rows = answers.size();
  table.unanswered =
      std::erase_if(answers, [](const ReadAnswer& answer) { return answer.row.response.empty(); });
  if (answers.empty()) {
    throw core::InvalidInput{fmt::format("{}: holds no answers", files.front().file)};
  }
  std::set<std::string> stimuli;
  for (const ReadAnswer& answer : answers) {
    stimuli.insert(answer.row.stimulus);
  }
  std::set<std::string> responses = stimuli;
  for (const auto& [given, meaning] : reading.responses) {
    responses.insert(meaning);
  }
  check_responses(answers, responses);
  table.stimuli = items_of(stimuli);
  table.responses = items_of(responses);
  for (ReadAnswer& answer : answers) {
    if (answer.row.mode != results::Mode::real) {
      table.modes.insert(results::to_text(answer.row.mode));
    }
    table.answers.push_back(std::move(answer.row));
  }
  count_on(table.answers);
  return table;
}
}  // namespace tapstudy::analysis
