#include "analysis/report/answer_tables/other_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "analysis/report/answer_tables/column_words.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
using Cells = std::vector<std::string_view>;  // of the rows and answers that are checked

// A column that is not read.
struct OtherColumn {
  std::string name;                       // as the header has it
  std::string description;                // described_column()
  Cells cells;                            // one an answer
  std::map<std::string_view, int> kinds;  // how often each value is there
};
// The answers of one file.
struct FileAnswers {
  std::vector<const AnswerOrigin*> origins;
  Cells participants;
  Cells stimuli;
  Cells responses;
  std::set<std::string, std::less<>> given;  // responses as the file has them, before --responses
  std::vector<OtherColumn> columns;
  bool has_times{};
};

[[noreturn]] void ask(const AnswerOrigin& at, const std::string& what) {
  throw core::InvalidInput{fmt::format("{}: {}", to_text(at), what)};
}

std::map<std::string_view, int> counted(const Cells& cells) {
  std::map<std::string_view, int> counts;
  for (const std::string_view cell : cells) {
    ++counts[cell];
  }
  return counts;
}

FileAnswers answers_of(const OtherColumns& file, const std::vector<AnswerRow>& answers,
                       const AnswerOrigins& origins) {
  FileAnswers of;
  of.has_times = file.has_times;
  const auto response =
      static_cast<std::size_t>(std::ranges::find(file.header, file.response) - file.header.begin());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (origins[i].csv == file.csv) {
      of.origins.push_back(&origins[i]);
      of.participants.push_back(answers[i].participant_id);
      of.stimuli.emplace_back(answers[i].stimulus);
      of.responses.push_back(answers[i].response);
      of.given.insert(only_answer_in(origins[i].row->cells[response]));
    }
  }
  for (const std::size_t place : file.places) {
    if (of.origins.empty() || file.header[place] == file.weight) {
      continue;
    }
    Cells cells;
    for (const AnswerOrigin* origin : of.origins) {
      cells.push_back(origin->row->cells[place]);
    }
    of.columns.push_back(
        {file.header[place], described_column(file.header, place), std::move(cells), {}});
    of.columns.back().kinds = counted(of.columns.back().cells);
  }
  return of;
}

bool are_missing_somewhere(const OtherColumn& column) {
  return std::ranges::any_of(column.kinds,
                             [](const auto& kind) { return is_missing(std::string{kind.first}); });
}

// The value at each key; empty where one key has several.
template <class Key>
std::map<Key, std::string_view> function_of(const std::vector<Key>& keys, const Cells& cells) {
  std::map<Key, std::string_view> values;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (values.try_emplace(keys[i], cells[i]).first->second != cells[i]) {
      return {};
    }
  }
  return values;
}

using Pair = std::pair<std::string_view, std::string_view>;  // stimulus and answer
// The pairs at which a column has a value.
struct MarkedPairs {
  std::string value;
  std::set<Pair> pairs;
  bool are_right() const {
    return std::ranges::all_of(pairs, [](const Pair& pair) { return pair.first == pair.second; });
  }
};

// Whether no stimulus and no answer is in two of the pairs, and there are two or more.
bool are_one_to_one(const std::set<Pair>& pairs) {
  std::set<std::string_view> stimuli;
  std::set<std::string_view> answers;
  for (const auto& [stimulus, answer] : pairs) {
    stimuli.insert(stimulus);
    answers.insert(answer);
  }
  return pairs.size() > 1 && stimuli.size() == pairs.size() && answers.size() == pairs.size();
}

// A column that has one of two values at one answer to each stimulus may say by it which are right.
// Those of the two of which that is true.
std::vector<MarkedPairs> marked_pairs(const FileAnswers& of, const OtherColumn& column) {
  if (column.kinds.size() != 2 || are_missing_somewhere(column)) {
    return {};
  }
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < of.stimuli.size(); ++i) {
    pairs.emplace_back(of.stimuli[i], of.responses[i]);
  }
  const auto values = function_of(pairs, column.cells);
  if (values.empty() || pairs.size() < 2 * values.size() ||
      !function_of(of.stimuli, column.cells).empty() ||
      !function_of(of.responses, column.cells).empty()) {
    return {};
  }
  std::vector<MarkedPairs> found;
  for (const auto& [value, count] : column.kinds) {
    MarkedPairs marked{std::string{value}, {}};
    for (const auto& [pair, at_pair] : values) {
      if (at_pair == value) {
        marked.pairs.insert(pair);
      }
    }
    if (are_one_to_one(marked.pairs)) {
      found.push_back(std::move(marked));
    }
  }
  return found;
}

bool says_errors(const std::string& name) {
  constexpr std::array<std::string_view, 9> stems{"err",  "wrong",  "incorr", "miss", "fehl",
                                                  "fals", "erreur", "faux",   "mist"};
  return has_word_beginning(name, stems);
}

void check_says_no_other_right(const FileAnswers& of, const OtherColumn& column) {
  const std::vector<MarkedPairs> marked = marked_pairs(of, column);
  const auto agrees = [&](const MarkedPairs& one) {
    // of two stimuli and two answers also the wrong ones are one to each
    const bool is_said_wrong =
        marked.size() > 1 && !says_errors(column.name) && right_or_wrong(one.value) == false;
    return one.are_right() && !is_said_wrong;
  };
  const auto other = std::ranges::find_if_not(marked, &MarkedPairs::are_right);
  if (other == marked.end() || std::ranges::any_of(marked, agrees)) {
    return;
  }
  const auto& [stimulus, answer] = *other->pairs.begin();
  ask(*of.origins.front(),
      fmt::format("{} is '{}' where '{}' was answered to '{}', and of one answer to each other "
                  "stimulus, as if these were the right ones, which the names do not say: say what "
                  "answers stand for by --responses GIVEN=STIMULUS, or --correct-column none",
                  column.description, other->value, answer, stimulus));
}

// "corrAns": for each stimulus the answer that is right.
void check_names_no_other_answer(const FileAnswers& of, const OtherColumn& column,
                                 const AnswerReading& reading) {
  const auto values = function_of(of.stimuli, column.cells);
  std::set<std::string_view> named;
  for (const auto& [stimulus, value] : values) {
    if (is_missing(std::string{value}) || !of.given.contains(value)) {
      return;
    }
    named.insert(value);
  }
  if (named.size() < 2 || named.size() < values.size()) {
    return;
  }
  for (const auto& [stimulus, value] : values) {
    const auto meaning = reading.responses.find(std::string{value});
    const std::string_view stands_for =
        meaning == reading.responses.end() ? value : std::string_view{meaning->second};
    if (stands_for != stimulus) {
      ask(*of.origins.front(),
          fmt::format("{} has the answer '{}' at every '{}', as if it were the right one, and it "
                      "stands for '{}': say what answers stand for by --responses GIVEN=STIMULUS, "
                      "or --correct-column none",
                      column.description, value, stimulus, stands_for));
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
  return has_word(name, known);
}

// Otherwise people who differ would be taken for one.
void check_tells_no_people(const FileAnswers& of, const OtherColumn& column) {
  constexpr int fewest_rows = 3;  // of each value
  const auto& kinds = column.kinds;
  const bool are_groups =
      kinds.size() > 1 && !are_missing_somewhere(column) &&
      std::ranges::all_of(kinds, [](const auto& kind) { return kind.second >= fewest_rows; });
  if (!are_groups || !function_of(of.stimuli, column.cells).empty() ||
      !function_of(of.responses, column.cells).empty()) {
    return;
  }
  const bool is_in_a_row = changes_in(column.cells) < 2 * kinds.size();
  if (is_in_a_row || is_called_after_people(column.name)) {
    ask(*of.origins.front(),
        fmt::format(
            "{0} may say whose answers these are ({1} values, each in {2} rows or more): "
            "--participant-column '{3}', or --participant-column {4} if nothing does",
            column.description, kinds.size(),
            std::ranges::min_element(kinds, {}, [](const auto& kind) { return kind.second; })
                ->second,
            column.name, no_column));
  }
}

// The rows of each participant, in their order.
std::map<std::string_view, std::vector<std::size_t>> rows_of_people(const FileAnswers& of) {
  std::map<std::string_view, std::vector<std::size_t>> people;
  for (std::size_t i = 0; i < of.participants.size(); ++i) {
    people[of.participants[i]].push_back(i);
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
  return has_word_beginning(name, stems);
}

// Two rows of one participant with the same number, in whatever columns that count anew.
std::optional<std::pair<std::size_t, std::size_t>> same_number(const FileAnswers& of,
                                                               const OtherColumn& numbers) {
  std::vector<const OtherColumn*> within;
  for (const OtherColumn& column : of.columns) {
    if (counts_anew(column.name)) {
      within.push_back(&column);
    }
  }
  std::map<Cells, std::size_t> known;
  for (std::size_t i = 0; i < numbers.cells.size(); ++i) {
    Cells key{of.participants[i], numbers.cells[i]};
    for (const OtherColumn* column : within) {
      key.push_back(column->cells[i]);
    }
    const auto [other, is_new] = known.emplace(std::move(key), i);
    if (!is_new && !is_missing(std::string{numbers.cells[i]})) {
      return std::pair{other->second, i};
    }
  }
  return std::nullopt;
}

void check_has_each_trial_once(const FileAnswers& of) {
  for (const OtherColumn& column : of.columns) {
    if (!numbers_trials(column.name)) {
      continue;
    }
    if (const auto twice = same_number(of, column)) {
      ask(*of.origins[twice->second],
          fmt::format("{} is '{}' here and at line {} of the same participant, as where a run was "
                      "begun anew or a question asked again: leave all but one out (--where "
                      "COLUMN=VALUE, or in the file), or count all by --pool-runs",
                      column.description, column.cells[twice->second],
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

// Whether each value of the column has the same answers to the same stimuli in the same order.
// Wrong answers recur so by no chance.
bool repeats_answers(const FileAnswers& of, const OtherColumn& column) {
  constexpr int fewest_wrong = 3;
  const int each = column.kinds.begin()->second;
  if (column.kinds.size() < 2 ||
      !std::ranges::all_of(column.kinds, [&](const auto& kind) { return kind.second == each; })) {
    return false;
  }
  std::map<std::string_view, std::vector<std::array<std::string_view, 3>>> answers;
  for (std::size_t i = 0; i < column.cells.size(); ++i) {
    answers[column.cells[i]].push_back({of.participants[i], of.stimuli[i], of.responses[i]});
  }
  const auto& first = answers.begin()->second;
  return std::ranges::count_if(first, [](const auto& one) { return one[1] != one[2]; }) >=
             fewest_wrong &&
         std::ranges::all_of(answers, [&](const auto& one) { return one.second == first; });
}

// As where columns were put below one another, where tables were joined, or where a program notes
// an answer with its screen and with its trial.
void check_has_answers_once(const FileAnswers& of) {
  for (const OtherColumn& column : of.columns) {
    if (!repeats_answers(of, column)) {
      continue;
    }
    ask(*of.origins.front(),
        fmt::format(
            "the same answers stand {0} times, once for each value of {1}, as where columns "
            "were put below one another or tables were joined: keep one of them (--where "
            "'{2}={3}'), or count all by --pool-runs",
            column.kinds.size(), column.description, column.name, column.kinds.begin()->first));
  }
}

bool are_numbers(const FileAnswers& of, const OtherColumn& column) {
  return std::ranges::all_of(column.kinds, [&](const auto& kind) {
    return of.origins.front()->csv->text.number(std::string{kind.first}).has_value();
  });
}

// The text at the first answers of each participant, if it stands nowhere else, and at fewer than
// three in ten.
std::optional<std::string> text_of_beginnings(const FileAnswers& of, const OtherColumn& column) {
  constexpr double most = 0.3;
  constexpr std::size_t most_kinds = 4;
  const Cells& cells = column.cells;
  const std::string text{cells.front()};
  if (is_missing(text) || column.kinds.size() > most_kinds || are_numbers(of, column)) {
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

void check_begins_not_with_practice(const FileAnswers& of, const OtherColumn& column) {
  if (const auto text = text_of_beginnings(of, column)) {
    ask(*of.origins.front(),
        fmt::format("{0} is '{1}' at the first answers of each participant and never later, as "
                    "practice may be called: leave them out (--where '{2}!={1}'), or "
                    "--count-practice",
                    column.description, *text, column.name));
  }
}

bool is_called_after_tasks(const std::string& name) {
  constexpr std::array<std::string_view, 8> known{"task",  "aufgabe", "tache", "tâche",
                                                  "tarea", "compito", "課題",  "paradigm"};
  return has_word(name, known);
}

// Its values, with an answer to each.
using Tasks = std::map<std::string_view, const AnswerOrigin*>;

void add_tasks(const FileAnswers& of, const OtherColumn& column, Tasks& tasks) {
  for (std::size_t i = 0; i < column.cells.size(); ++i) {
    if (!is_missing(std::string{column.cells[i]})) {
      tasks.emplace(column.cells[i], of.origins[i]);
    }
  }
}

// Answers to different tasks are no matrix of one, whichever file they are in.
void check_is_of_one_task(const std::vector<FileAnswers>& files) {
  std::map<std::string, Tasks> tasks_of;  // by column
  for (const FileAnswers& of : files) {
    for (const OtherColumn& column : of.columns) {
      if (is_called_after_tasks(column.name)) {
        add_tasks(of, column, tasks_of[column.name]);
      }
    }
  }
  for (const auto& [column, tasks] : tasks_of) {
    if (tasks.size() < 2) {
      continue;
    }
    std::vector<std::string_view> names;
    std::ranges::transform(tasks, std::back_inserter(names), &Tasks::value_type::first);
    ask(*tasks.rbegin()->second,
        fmt::format("the column '{0}' names {1} tasks ({2}), whose answers are no matrix of one: "
                    "keep one of them (--where '{0}={3}'), or count all by --pool-tasks",
                    column, names.size(), fmt::join(names, ", "), names.front()));
  }
}

void check_column(const FileAnswers& of, const OtherColumn& column, const AnswerReading& reading,
                  bool are_participants_known) {
  if (reading.columns.correct.empty()) {
    check_says_no_other_right(of, column);
    check_names_no_other_answer(of, column, reading);
  }
  if (!are_participants_known && reading.columns.participant.empty()) {
    check_tells_no_people(of, column);
  }
  if (!reading.counts_practice) {
    check_begins_not_with_practice(of, column);
  }
}
}  // namespace

void check_other_columns(const std::vector<OtherColumns>& files,
                         const std::vector<AnswerRow>& answers, const AnswerOrigins& origins,
                         const AnswerReading& reading, bool are_participants_known) {
  const bool has_runs_alone =
      !reading.pools_runs && are_participants_known && !is_counted_already(answers);
  std::vector<FileAnswers> all;
  for (const OtherColumns& file : files) {
    all.push_back(answers_of(file, answers, origins));
  }
  for (const FileAnswers& of : all) {
    for (const OtherColumn& column : of.columns) {
      check_column(of, column, reading, are_participants_known);
    }
    if (has_runs_alone) {
      check_has_answers_once(of);
      check_has_each_trial_once(of);
      check_has_each_row_once(of);
    }
  }
  if (!reading.pools_tasks) {
    check_is_of_one_task(all);
  }
}
}  // namespace tapstudy::analysis
