// What columns say by their values, whatever they are called.
#include "analysis/report/answer_tables/other_columns.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <sstream>

#include "core/error.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
constexpr std::array plates{"oak", "ash", "elm"};
constexpr int people = 3;
constexpr int trials = 24;

struct Trial {
  int person{};
  int number{};
  std::size_t presented{};
  std::size_t answered{};
};
using Column = std::function<std::string(const Trial& trial)>;

// People who are right in two of three answers, with one more column.
std::string table_with(const std::string& name, const Column& cell, bool has_participants = true) {
  std::string text = has_participants ? "participant," : "";
  text += "stimulus,response," + name + "\n";
  for (int person = 0; person < people; ++person) {
    for (int number = 0; number < trials; ++number) {
      const auto presented = static_cast<std::size_t>(number) % plates.size();
      const std::size_t wrong = presented + 1 + static_cast<std::size_t>(number) / 12;
      const std::size_t answered = number % 4 == 3 ? wrong % plates.size() : presented;
      text += has_participants ? fmt::format("P{},", person) : "";
      text += fmt::format("{},{},{}\n", plates.at(presented), answered + 1,
                          cell({person, number, presented, answered}));
    }
  }
  return text;
}

AnswerReading keys(const std::array<const char*, 3>& meanings = plates) {
  AnswerReading reading;
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    reading.responses[std::to_string(i + 1)] = meanings.at(i);
  }
  return reading;
}

std::string outcome_of(const std::string& text, const AnswerReading& reading) {
  std::istringstream stream{text};
  try {
    read_answers({{"answers.csv", read_csv(stream, "answers.csv")}}, reading);
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}
const std::array<const char*, 3> other_plates{"ash", "oak", "elm"};
}  // namespace

TEST_CASE("a column that says which answers are right, in any words, is held against the names",
          "[analysis][answer_tables]") {
  const auto [right, wrong] = GENERATE(
      table<std::string, std::string>({{"1", "0"}, {"ja", "nein"}, {"0", "1"}, {"✓", "✗"}}));
  const std::string text = table_with("zork", [right = right, wrong = wrong](const Trial& trial) {
    return trial.presented == trial.answered ? right : wrong;
  });
  CHECK(outcome_of(text, keys()) == "accepted");
  AnswerReading contrary = keys(other_plates);
  CHECK_THAT(outcome_of(text, contrary), Contains("column 'zork' is '" + right + "' where ") &&
                                             Contains("--responses") &&
                                             Contains("--correct-column"));
  contrary.columns.correct = no_column;
  CHECK(outcome_of(text, contrary) == "accepted");
}

TEST_CASE("a column of right answers is held against the names", "[analysis][answer_tables]") {
  const std::string text =
      table_with("zork", [](const Trial& trial) { return std::to_string(trial.presented + 1); });
  CHECK(outcome_of(text, keys()) == "accepted");
  CHECK_THAT(outcome_of(text, keys(other_plates)),
             Contains("column 'zork' has the answer '2' at every 'ash'") &&
                 Contains("it stands for 'oak'"));
}

TEST_CASE("few values in many rows each may be people, and are asked about",
          "[analysis][answer_tables]") {
  const std::string text = table_with(
      "zork", [](const Trial& trial) { return fmt::format("x{}", trial.person); }, false);
  CHECK_THAT(outcome_of(text, keys()), Contains("column 'zork' may say whose answers these are (3 "
                                                "values, each in 24 rows") &&
                                           Contains("--participant-column none"));
  AnswerReading unknown = keys();
  unknown.columns.participant = no_column;
  CHECK(outcome_of(text, unknown) == "accepted");
  const auto thickness = [](const Trial& trial) { return std::to_string(trial.presented); };
  CHECK(outcome_of(table_with("thickness_mm", thickness, false), keys()) == "accepted");
  const auto time = [](const Trial& trial) { return fmt::format("{}.5", trial.number); };
  CHECK(outcome_of(table_with("zork", time, false), keys()) == "accepted");
}

TEST_CASE("a trial's number stands once for each participant, but for blocks that count anew",
          "[analysis][answer_tables]") {
  const std::string name = GENERATE("trial", "Trial Number", "trial_index", "TrialNr");
  const auto number = [](const Trial& trial) { return std::to_string(trial.number + 1); };
  CHECK(outcome_of(table_with(name, number), keys()) == "accepted");
  const auto anew = [](const Trial& trial) { return std::to_string(trial.number % 12); };
  CHECK_THAT(outcome_of(table_with(name, anew), keys()),
             Contains("answers.csv:14: column '" + name + "' is '0' here and at line 2") &&
                 Contains("--pool-runs"));
  AnswerReading pooled = keys();
  pooled.pools_runs = true;
  CHECK(outcome_of(table_with(name, anew), pooled) == "accepted");
  const auto in_blocks = [&](const Trial& trial) {
    return fmt::format("{},{}", anew(trial), trial.number / 12);
  };
  CHECK(outcome_of(table_with(name + ",block", in_blocks), keys()) == "accepted");
}

TEST_CASE("rows that are the same to the letter, time included, are asked about",
          "[analysis][answer_tables]") {
  const auto time = [](const Trial& trial) {
    return fmt::format("1.{}{}", trial.person, 10 + trial.number);
  };
  const std::string text = table_with("response_time_s", time);
  CHECK(outcome_of(text, keys()) == "accepted");
  const std::string twice = text + text.substr(text.find('\n') + 1);
  CHECK_THAT(outcome_of(twice, keys()), Contains("is the same to the letter as line "));
}

TEST_CASE("answers that stand once for each value of a column are asked about",
          "[analysis][answer_tables]") {
  const std::string text = table_with("zork", [](const Trial&) { return "time"; });
  std::string below = text;  // as R's rbind() has it
  std::string melted;        // as pivot_longer() has it
  std::istringstream rows{text};
  for (std::string row; std::getline(rows, row);) {
    const std::string other = row.substr(0, row.rfind(',')) + ",confidence\n";
    below += melted.empty() ? "" : other;
    melted += melted.empty() ? row + "\n" : row + "\n" + other;
  }
  AnswerReading one = keys();
  for (const std::string& table : {below, melted}) {
    CHECK_THAT(outcome_of(table, keys()),
               Contains("stand 2 times, once for each value of column 'zork'") &&
                   Contains("--where 'zork=confidence'"));
    one.conditions = {{"zork", "confidence", false}};
    CHECK(outcome_of(table, one) == "accepted");
  }
  AnswerReading pooled = keys();
  pooled.pools_runs = true;
  CHECK(outcome_of(below, pooled) == "accepted");
  const auto half = [](const Trial& trial) { return trial.number % 24 < 12 ? "x" : "y"; };
  CHECK(outcome_of(table_with("block", half), keys()) == "accepted");
}

TEST_CASE("dates of any column, and sessions of any spelling, tell runs apart",
          "[analysis][answer_tables]") {
  const auto [name, first, second] = GENERATE(table<std::string, std::string, std::string>(
      {{"zork", "2026-11-02", "2026-11-03"},
       {"zork", "02.11.2026 14:05", "03.11.2026 09:10"},
       {"sessionID", "k1", "k2"},
       {"Datum", "Montag", "Dienstag"}}));
  const std::string text = table_with(name, [first = first, second = second](const Trial& trial) {
    return trial.number < trials / 2 ? first : second;
  });
  CHECK_THAT(outcome_of(text, keys()),
             Contains("participant 'P0' took part 2 times: " + name + " '" + first + "'"));
  const auto of_person = [](const Trial& trial) {
    return fmt::format("2026-11-{:02}", trial.person + 1);
  };
  CHECK(outcome_of(table_with(name, of_person), keys()) == "accepted");
}

TEST_CASE("a word at everybody's first answers alone may be practice, in any language",
          "[analysis][answer_tables]") {
  const auto beginning = [](const Trial& trial) {
    return trial.number < 6 ? "gyakorlás" : "mérés";
  };
  const std::string text = table_with("zork", beginning);
  CHECK_THAT(outcome_of(text, keys()),
             Contains("column 'zork' is 'gyakorlás' at the first answers of each participant") &&
                 Contains("--where 'zork!=gyakorlás'"));
  AnswerReading counting = keys();
  counting.counts_practice = true;
  CHECK(outcome_of(text, counting) == "accepted");
  const auto half = [](const Trial& trial) { return trial.number < 12 ? "soft" : "hard"; };
  CHECK(outcome_of(table_with("zork", half), keys()) == "accepted");
}

TEST_CASE("words that only begin like those of practice and exclusion are no such words",
          "[analysis][answer_tables]") {
  const auto [one, other] = GENERATE(table<std::string, std::string>({{"bottom", "top"},
                                                                      {"warm", "cold"},
                                                                      {"familiar", "new"},
                                                                      {"bad", "good"},
                                                                      {"both", "left"}}));
  const std::string text = table_with("zork", [one = one, other = other](const Trial& trial) {
    return trial.number % 6 == 5 ? one : other;
  });
  CHECK(outcome_of(text, keys()) == "accepted");
}

TEST_CASE("rows that a column calls excluded, or no trial that counts, are asked about",
          "[analysis][answer_tables]") {
  const auto [name, cell, other] =
      GENERATE(table<std::string, std::string, std::string>({{"excluded", "yes", "no"},
                                                             {"includeTrial", "0", "1"},
                                                             {"is_valid", "false", "true"},
                                                             {"trial_kind", "catch", "plate"},
                                                             {"attentionCheck", "1", "0"},
                                                             {"isPractice", "1", "0"},
                                                             {"Phase", "Übung", "Test"}}));
  const std::string text = table_with(name, [cell = cell, other = other](const Trial& trial) {
    return trial.number % 6 == 5 ? cell : other;
  });
  CHECK_THAT(outcome_of(text, keys()),
             Contains("column '" + name + "' says '" + cell + "': 12 of 72"));
}

TEST_CASE("answers of two tasks are one matrix only if that is asked for", "[analysis][counts]") {
  const auto task = [](const Trial& trial) { return trial.number % 8 < 5 ? "tapping" : "rubbing"; };
  for (const char* const name : {"task", "Task_name", "Aufgabe"}) {
    INFO(name);
    CHECK_THAT(outcome_of(table_with(name, task), keys()),
               Contains("names 2 tasks (rubbing, tapping)") && Contains("--where '") &&
                   Contains("=rubbing'") && Contains("--pool-tasks"));
  }
  AnswerReading reading = keys();
  reading.pools_tasks = true;
  CHECK(outcome_of(table_with("task", task), reading) == "accepted");
  reading = keys();
  reading.conditions = {{"task", "tapping", false}};
  CHECK(outcome_of(table_with("task", task), reading) == "accepted");
  CHECK(outcome_of(table_with("task", [](const Trial&) { return "tapping"; }), keys()) ==
        "accepted");
  // a column of another name says nothing of tasks
  CHECK(outcome_of(table_with("hand", task), keys()) == "accepted");
}

TEST_CASE("tasks of different files are not one matrix either", "[analysis][counts]") {
  const auto table = [](const char* task) {
    std::istringstream stream{table_with("task", [task](const Trial&) { return task; })};
    return read_csv(stream, task);
  };
  const auto read = [&](const char* first, const char* second) {
    std::vector<NamedCsv> files;
    files.push_back({first, table(first)});
    files.push_back({second, table(second)});
    AnswerReading reading = keys();
    reading.pools_runs = true;
    read_answers(std::move(files), reading);
  };
  CHECK_THROWS_WITH(read("tapping", "rubbing"), Contains("names 2 tasks"));
  CHECK_NOTHROW(read("tapping", "tapping"));
}
