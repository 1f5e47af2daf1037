#include "analysis/report/answer_tables/other_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "analysis/report/answer_tables/foreign_text.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
std::vector<std::string> words_of_name(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) {
      words.push_back(as_read(word));
      word.clear();
    }
  };
  bool was_small = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_of_word = byte >= 0x80 || std::isalnum(byte) != 0;
    if (!is_of_word || (was_small && std::isupper(byte) != 0)) {
      end_word();
    }
    if (is_of_word) {
      word += c;
    }
    was_small = std::islower(byte) != 0;
  }
  end_word();
  return words;
}

bool tells_runs(const std::string& name) {
  constexpr std::array<std::string_view, 16> known{
      "session", "sessionid", "sitzung",   "run",       "runid",   "visit",     "day",    "tag",
      "date",    "datum",     "startdate", "timestamp", "logfile", "recording", "result", "fecha"};
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::find(known, word) != known.end();
  });
}

bool looks_like_date(const std::string& cell) {
  std::vector<std::size_t> lengths;  // of groups of digits that '-', '.' or '/' join, at the start
  std::size_t digits = 0;
  for (const char c : cell + " ") {
    if (std::isdigit(static_cast<unsigned char>(c)) != 0) {
      ++digits;
      continue;
    }
    lengths.push_back(std::exchange(digits, 0));
    if (c != '-' && c != '.' && c != '/') {
      break;
    }
  }
  constexpr std::size_t parts = 3;
  const auto is_short = [](std::size_t length) { return length == 1 || length == 2; };
  return lengths.size() == parts && is_short(lengths[1]) &&
         ((lengths[0] == 4 && is_short(lengths[2])) ||
          (is_short(lengths[0]) && (lengths[2] == 4 || lengths[2] == 2)));
}

namespace {
using results::AnswerRow;
using Cells = std::vector<std::string>;

// A column that is not read, and what else the same rows hold.
struct OtherColumn {
  std::string name;  // described_column()
  Cells cells;
  const AnswerOrigin* first{};
};
struct FileAnswers {
  std::vector<const AnswerRow*> answers;
  std::vector<const AnswerOrigin*> origins;
  Cells given;  // as the file has them, before --responses
  std::vector<OtherColumn> columns;
  std::vector<std::string> names;  // of the columns, as the header has them
  bool has_times{};
};

[[noreturn]] void ask(const AnswerOrigin& at, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}: {}", to_text(at), what)};
}

FileAnswers answers_of(const OtherColumns& file, const std::vector<AnswerRow>& answers,
                       const AnswerOrigins& origins) {
  FileAnswers of;
  const auto response =
      static_cast<std::size_t>(std::ranges::find(file.header, file.response) - file.header.begin());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (origins[i].csv == file.csv) {
      of.answers.push_back(&answers[i]);
      of.origins.push_back(&origins[i]);
      of.given.push_back(only_answer_in(origins[i].row->cells[response]));
    }
  }
  for (const std::size_t place : file.places) {
    OtherColumn column{described_column(file.header, place), {}, nullptr};
    for (const AnswerOrigin* origin : of.origins) {
      column.cells.push_back(origin->row->cells[place]);
    }
    if (!column.cells.empty() && file.header[place] != file.weight) {
      column.first = of.origins.front();
      of.columns.push_back(std::move(column));
      of.names.push_back(file.header[place]);
    }
  }
  return of;
}

Cells field_of(const FileAnswers& of, std::string AnswerRow::*field) {
  Cells cells;
  for (const AnswerRow* answer : of.answers) {
    cells.push_back(answer->*field);
  }
  return cells;
}

std::map<std::string, int> counted(const Cells& cells) {
  std::map<std::string, int> counts;
  for (const std::string& cell : cells) {
    ++counts[cell];
  }
  return counts;
}

bool are_missing_somewhere(const Cells& cells) {
  return std::ranges::any_of(cells, is_missing);
}

// The value at each key; empty where one key has several.
template <class Key>
std::map<Key, std::string> function_of(const std::vector<Key>& keys, const Cells& cells) {
  std::map<Key, std::string> values;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (values.try_emplace(keys[i], cells[i]).first->second != cells[i]) {
      return {};
    }
  }
  return values;
}

using Pair = std::pair<std::string, std::string>;  // stimulus and answer

// The pairs at which the column has the value, if no stimulus and no answer is in two of them, and
// there are two or more.
std::set<Pair> one_to_one(const std::map<Pair, std::string>& values, const std::string& value) {
  std::set<Pair> pairs;
  std::set<std::string> stimuli;
  std::set<std::string> answers;
  for (const auto& [pair, at_pair] : values) {
    if (at_pair == value) {
      if (!stimuli.insert(pair.first).second || !answers.insert(pair.second).second) {
        return {};
      }
      pairs.insert(pair);
    }
  }
  return pairs.size() > 1 ? pairs : std::set<Pair>{};
}

bool says_errors(const std::string& name) {
  constexpr std::array<std::string_view, 9> stems{"err",  "wrong",  "incorr", "miss", "fehl",
                                                  "fals", "erreur", "faux",   "mist"};
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::any_of(stems,
                               [&](std::string_view stem) { return word.starts_with(stem); });
  });
}

// By its values a column says which answers are right where it has one of two values at one answer
// to each stimulus.
void check_says_no_other_right(const FileAnswers& of, const OtherColumn& column,
                               const std::string& name) {
  const auto kinds = counted(column.cells);
  if (kinds.size() != 2 || are_missing_somewhere(column.cells)) {
    return;
  }
  std::vector<Pair> pairs;
  for (const AnswerRow* answer : of.answers) {
    pairs.emplace_back(answer->stimulus, answer->response);
  }
  const auto values = function_of(pairs, column.cells);
  if (values.empty() || of.answers.size() < 2 * values.size() ||
      !function_of(field_of(of, &AnswerRow::stimulus), column.cells).empty() ||
      !function_of(field_of(of, &AnswerRow::response), column.cells).empty()) {
    return;
  }
  const std::string& one = kinds.begin()->first;
  const std::string& other = kinds.rbegin()->first;
  const std::set<Pair> sets[]{one_to_one(values, one), one_to_one(values, other)};
  const auto are_right = [](const std::set<Pair>& found) {
    return !found.empty() &&
           std::ranges::all_of(found, [](const Pair& pair) { return pair.first == pair.second; });
  };
  // of two stimuli and two answers also the wrong ones are one to each
  const auto is_called = [&](const std::string& value, bool right) {
    return right_or_wrong(value) == right;
  };
  const bool is_contrary = !sets[0].empty() && !sets[1].empty() && !says_errors(name) &&
                           ((are_right(sets[0]) && is_called(one, false)) ||
                            (are_right(sets[1]) && is_called(other, false)));
  const bool agrees = (are_right(sets[0]) || are_right(sets[1])) && !is_contrary;
  if (agrees || (sets[0].empty() && sets[1].empty())) {
    return;
  }
  const std::set<Pair>& marked =
      sets[0].empty() || (is_contrary && are_right(sets[0])) ? sets[1] : sets[0];
  ask(*column.first,
      fmt::format("{} is '{}' where '{}' was answered to '{}', and of one answer to each other "
                  "stimulus, as if these were the right ones, which the names do not say: say what "
                  "answers stand for by --responses GIVEN=STIMULUS, or --correct-column none",
                  column.name, values.at(*marked.begin()), marked.begin()->second,
                  marked.begin()->first));
}

// "corrAns": for each stimulus the answer that is right.
void check_names_no_other_answer(const FileAnswers& of, const OtherColumn& column,
                                 const AnswerReading& reading) {
  const auto values = function_of(field_of(of, &AnswerRow::stimulus), column.cells);
  const std::set<std::string> given{of.given.begin(), of.given.end()};
  std::set<std::string> named;
  for (const auto& [stimulus, value] : values) {
    if (is_missing(value) || !given.contains(value)) {
      return;
    }
    named.insert(value);
  }
  if (named.size() < 2 || named.size() < values.size()) {
    return;
  }
  for (const auto& [stimulus, value] : values) {
    const auto meaning = reading.responses.find(value);
    const std::string& stands_for = meaning == reading.responses.end() ? value : meaning->second;
    if (stands_for != stimulus) {
      ask(*column.first,
          fmt::format("{} has the answer '{}' at every '{}', as if it were the right one, and it "
                      "stands for '{}': say what answers stand for by --responses GIVEN=STIMULUS, "
                      "or --correct-column none",
                      column.name, value, stimulus, stands_for));
    }
  }
}

std::size_t changes_in(const Cells& cells) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    changes += cells[i] != cells[i - 1] ? 1 : 0;
  }
  return changes;
}

bool is_called_after_people(const std::string& name) {
  constexpr std::array<std::string_view, 14> known{
      "id",     "sub",  "subj", "sujet", "user",           "code",     "ppt",
      "person", "name", "who",  "vp",    "versuchsperson", "initials", "sid"};
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::find(known, word) != known.end();
  });
}

// Otherwise people who differ would be taken for one.
void check_tells_no_people(const FileAnswers& of, const OtherColumn& column,
                           const std::string& name) {
  constexpr int fewest_rows = 3;  // of each value
  const auto kinds = counted(column.cells);
  const bool are_groups =
      kinds.size() > 1 && !are_missing_somewhere(column.cells) &&
      std::ranges::all_of(kinds, [](const auto& kind) { return kind.second >= fewest_rows; });
  if (!are_groups || !function_of(field_of(of, &AnswerRow::stimulus), column.cells).empty() ||
      !function_of(field_of(of, &AnswerRow::response), column.cells).empty()) {
    return;
  }
  const bool is_in_a_row = changes_in(column.cells) < 2 * kinds.size();
  if (is_in_a_row || is_called_after_people(name)) {
    ask(*column.first,
        fmt::format(
            "{0} may say whose answers these are ({1} values, each in {2} rows or more): "
            "--participant-column '{3}', or --participant-column {4} if nothing does",
            column.name, kinds.size(),
            std::ranges::min_element(kinds, {}, [](const auto& kind) { return kind.second; })
                ->second,
            name, no_column));
  }
}

// The rows of each participant, in their order.
std::map<std::string, std::vector<std::size_t>> rows_of_people(const FileAnswers& of) {
  std::map<std::string, std::vector<std::size_t>> people;
  for (std::size_t i = 0; i < of.answers.size(); ++i) {
    people[of.answers[i]->participant_id].push_back(i);
  }
  return people;
}

bool numbers_trials(const std::string& name) {
  constexpr std::array<std::string_view, 10> known{"trial",     "trialnumber", "trialno", "trialnr",
                                                   "trialnum",  "trialindex",  "trialid", "trialn",
                                                   "durchgang", "essai"};
  std::string whole;
  for (const std::string& word : words_of_name(name)) {
    whole += word;
  }
  return std::ranges::find(known, whole) != known.end();
}

// What counts trials from 1 again: with it, a number stands once.
bool counts_anew(const std::string& name) {
  constexpr std::array<std::string_view, 12> stems{"block", "loop",  "rep",  "part",
                                                   "list",  "cycle", "task", "cond",
                                                   "phase", "sess",  "run",  "set"};
  return std::ranges::any_of(words_of_name(name), [&](const std::string& word) {
    return std::ranges::any_of(stems,
                               [&](std::string_view stem) { return word.starts_with(stem); });
  });
}

// Two rows of one participant with the same number, whatever column of those that count anew.
std::optional<std::pair<std::size_t, std::size_t>> same_number(const FileAnswers& of,
                                                               const Cells& numbers) {
  std::map<std::vector<std::string>, std::size_t> known;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::vector<std::string> key{of.answers[i]->participant_id, numbers[i]};
    for (std::size_t column = 0; column < of.columns.size(); ++column) {
      if (counts_anew(of.names[column])) {
        key.push_back(of.columns[column].cells[i]);
      }
    }
    const auto [other, is_new] = known.emplace(std::move(key), i);
    if (!is_new && !is_missing(numbers[i])) {
      return std::pair{other->second, i};
    }
  }
  return std::nullopt;
}

void check_has_each_trial_once(const FileAnswers& of) {
  for (std::size_t column = 0; column < of.columns.size(); ++column) {
    if (!numbers_trials(of.names[column])) {
      continue;
    }
    if (const auto twice = same_number(of, of.columns[column].cells)) {
      ask(*of.origins[twice->second],
          fmt::format("{} is '{}' here and at line {} of the same participant, as where a run was "
                      "begun anew or a question asked again: leave all but one out (--where "
                      "COLUMN=VALUE, or in the file), or count all by --pool-runs",
                      of.columns[column].name, of.columns[column].cells[twice->second],
                      of.origins[twice->first]->row->line));
    }
  }
}

// Two answers that took as long to the digit are rare, a tenth of all is not by chance.
void check_has_each_row_once(const FileAnswers& of) {
  std::map<std::vector<std::string>, std::size_t> known;
  std::size_t copies = 0;
  std::pair<std::size_t, std::size_t> last;
  for (std::size_t i = 0; i < of.origins.size(); ++i) {
    const auto [other, is_new] = known.emplace(of.origins[i]->row->cells, i);
    copies += is_new ? 0 : 1;
    last = is_new ? last : std::pair{other->second, i};
  }
  constexpr std::size_t fewest = 2;
  constexpr std::size_t one_in = 10;
  if (of.has_times && copies >= fewest && one_in * copies >= of.origins.size()) {
    ask(*of.origins[last.second],
        fmt::format("is the same to the letter as line {}, time included, and so are {} of {} rows "
                    "as others: leave the copies out, or count all by --pool-runs",
                    of.origins[last.first]->row->line, copies, of.origins.size()));
  }
}

bool are_numbers(const FileAnswers& of, const Cells& cells) {
  return std::ranges::all_of(cells, [&](const std::string& cell) {
    return of.origins.front()->csv->text.number(cell).has_value();
  });
}

// The text at the first answers of each participant, if it stands nowhere else, and at fewer than
// three in ten.
std::optional<std::string> text_of_beginnings(const FileAnswers& of, const Cells& cells) {
  constexpr double most = 0.3;
  const std::string& text = cells.front();
  if (is_missing(text) || are_numbers(of, cells) || counted(cells).size() > 4) {
    return std::nullopt;
  }
  for (const auto& [person, rows] : rows_of_people(of)) {
    const auto is_text = [&](std::size_t row) { return cells[row] == text; };
    const auto number = std::ranges::count_if(rows, is_text);
    const bool are_first = std::all_of(rows.begin(), rows.begin() + number, is_text);
    if (number == 0 || !are_first ||
        static_cast<double>(number) >= most * static_cast<double>(rows.size())) {
      return std::nullopt;
    }
  }
  return text;
}

void check_begins_not_with_practice(const FileAnswers& of, const OtherColumn& column,
                                    const std::string& name) {
  if (const auto text = text_of_beginnings(of, column.cells)) {
    ask(*column.first,
        fmt::format("{0} is '{1}' at the first answers of each participant and never later, as "
                    "practice may be called: leave them out (--where '{2}!={1}'), or "
                    "--count-practice",
                    column.name, *text, name));
  }
}
}  // namespace

void check_other_columns(const std::vector<OtherColumns>& files,
                         const std::vector<AnswerRow>& answers, const AnswerOrigins& origins,
                         const AnswerReading& reading, bool are_participants_known) {
  for (const OtherColumns& file : files) {
    FileAnswers of = answers_of(file, answers, origins);
    of.has_times = file.has_times;
    for (std::size_t i = 0; i < of.columns.size(); ++i) {
      if (reading.columns.correct.empty()) {
        check_says_no_other_right(of, of.columns[i], of.names[i]);
        check_names_no_other_answer(of, of.columns[i], reading);
      }
      if (!are_participants_known && reading.columns.participant.empty()) {
        check_tells_no_people(of, of.columns[i], of.names[i]);
      }
      if (!reading.counts_practice) {
        check_begins_not_with_practice(of, of.columns[i], of.names[i]);
      }
    }
    if (!reading.pools_runs && are_participants_known && !is_counted_already(answers)) {
      check_has_each_trial_once(of);
      check_has_each_row_once(of);
    }
  }
}
}  // namespace tapstudy::analysis
