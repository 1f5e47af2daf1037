// Discrimination tasks and the procedures that choose their stimuli, in whole sessions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "protocols/reader/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program(
             {"/usr/bin/sqlite3", "-separator", " ", (directory / "study") + "/study.db", query})
      .standard_output;
}

testing::ProgramResult session(const TempDirectory& directory, const std::string& protocol,
                               const std::string& input,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{
      "run", protocol, "--participant", "P01", "--out", directory / "study", "--seed", "5"};
  line.insert(line.end(), more.begin(), more.end());
  return testing::tapstudy(line, input);
}

std::string staircase_study(const TempDirectory& directory, const std::string& procedure) {
  const std::string file = directory / "study.yaml";
  testing::write(file, testing::replaced(
                           testing::contents(testing::source("tests/data/same_alternatives.yaml")),
                           "constant: {values: [0.0], repetitions: 240}", procedure));
  return file;
}
const std::string staircase =
    "staircase: {rule: transformed, n_down: 2, steps: linear, first_step: 0.4, min_step: 0.1, "
    "start: 0.8, min: 0.0, max: 1.0, stop: {trials: 8}, estimate_reversals: 2}";
const std::string psi =
    "psi: {function: weibull, stimulus: {min: 0.05, max: 1.0, count: 12}, threshold: "
    "{min: 0.05, max: 1.0, count: 12}, slope: {values: [1, 3]}, guess: 0.5, lapse: "
    "0.02, stop: {trials: 8}}";
// The comparison's values, in the order presented.
std::string levels(const TempDirectory& directory) {
  return sql(directory,
             "SELECT round(value, 6) FROM axis_value JOIN alternative USING (trial_id, position) "
             "JOIN trial USING (trial_id) WHERE is_comparison AND status = 'answered' "
             "ORDER BY trial_id");
}

// The materials and plates of that study with other blocks.
std::string with_blocks(const std::string& study, const std::string& blocks) {
  return study.substr(0, study.find("blocks:\n")) + "blocks:\n" + blocks +
         study.substr(study.find("simulation:"));
}
}  // namespace

TEST_CASE("alternatives that are physically the same are told apart by chance in every task",
          "[end_to_end][slow]") {
  const TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::source("tests/data/same_alternatives.yaml"),
                             "--participants", "9", "--seed", "4", "--out", directory / "study"})
              .exit_code == 0);
  const std::map<std::string, double> chance{{"comparison", 0.5},
                                             {"same_different", 0.5},
                                             {"odd_one_out", 1.0 / 3.0},
                                             {"abx", 0.5},
                                             {"match_to_sample", 1.0 / 3.0}};
  std::istringstream rows{
      sql(directory,
          "SELECT block, sum(is_correct), count(*) FROM current_response "
          "JOIN trial USING (trial_id) WHERE is_correct IS NOT NULL GROUP BY block")};
  std::string block;
  int right = 0;
  int answers = 0;
  int blocks = 0;
  while (rows >> block >> right >> answers) {
    CAPTURE(block, right, answers);
    ++blocks;
    CHECK(answers >= 2000);
    const double p = chance.at(block);
    CHECK(right == Approx(answers * p).margin(4.0 * std::sqrt(answers * p * (1.0 - p))));
  }
  CHECK(blocks == 5);
  const double first =
      std::stod(sql(directory,
                    "SELECT avg(response = stimulus) FROM current_response "
                    "JOIN alternative USING (trial_id) JOIN trial USING (trial_id) "
                    "WHERE block = 'paired' AND position = 0"));
  CHECK(first == Approx(0.5).margin(4.0 * 0.5 / std::sqrt(9.0 * 240.0)));
  std::istringstream ranked_first{
      sql(directory,
          "SELECT avg(position = 0), avg(stimulus = 'one'), count(*) FROM current_response "
          "JOIN alternative USING (trial_id) JOIN trial USING (trial_id) "
          "WHERE block = 'ranking' AND response LIKE stimulus || ' %'")};
  double by_label = 0.0;
  double by_stimulus = 0.0;
  double rankings = 0.0;
  ranked_first >> by_label >> by_stimulus >> rankings;
  REQUIRE(rankings == 9.0 * 230.0);
  const double margin = 4.0 * std::sqrt(2.0 / 9.0 / rankings);
  CHECK(by_label == Approx(1.0 / 3.0).margin(margin));
  CHECK(by_stimulus == Approx(1.0 / 3.0).margin(margin));
}

TEST_CASE("alternatives that are physically the same are named, chosen and rated alike",
          "[end_to_end][slow]") {
  const TempDirectory directory;
  const std::string text = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  testing::write(
      directory / "study.yaml",
      with_blocks(
          text,
          "  - {name: named, task: identification, question: Which one, stimuli: [one, other, "
          "third], repetitions: 75}\n"
          "  - {name: chosen, task: choice, question: Which one, stimuli: [one, other, third], "
          "repetitions: 225}\n"
          "  - {name: rated, task: rating, question: How real, stimuli: [one, other, third], "
          "steps: 7, low: not, high: fully, repetitions: 75}\n"));
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "9", "--seed",
                             "4", "--out", directory / "study"})
              .exit_code == 0);
  std::istringstream shares{
      sql(directory,
          "SELECT avg(is_correct), (SELECT avg(response = 'one') FROM current_response JOIN trial "
          "USING (trial_id) WHERE block = 'chosen'), (SELECT avg(response = 'other') FROM "
          "current_response JOIN trial USING (trial_id) WHERE block = 'chosen') "
          "FROM current_response JOIN trial USING (trial_id) WHERE block = 'named'")};
  double right = 0.0;
  double one = 0.0;
  double other = 0.0;
  shares >> right >> one >> other;
  const double margin = 4.0 * std::sqrt(2.0 / 9.0 / (9.0 * 225.0));
  CHECK(right == Approx(1.0 / 3.0).margin(margin));
  CHECK(one == Approx(1.0 / 3.0).margin(margin));
  CHECK(other == Approx(1.0 / 3.0).margin(margin));
  // of ratings the variance within a participant, which is all that can differ by stimulus
  std::istringstream ratings{
      sql(directory,
          "WITH rated AS (SELECT participant_id, stimulus, CAST(response AS REAL) AS r FROM "
          "v_answers WHERE block = 'rated'), own AS (SELECT participant_id, avg(r) AS mean FROM "
          "rated GROUP BY participant_id), away AS (SELECT stimulus, r - mean AS d FROM rated JOIN "
          "own USING (participant_id)) SELECT max(m), avg(v) FROM (SELECT abs(avg(d)) AS m, "
          "avg(d * d) AS v FROM away GROUP BY stimulus)")};
  double farthest = 1.0;
  double variance = 0.0;
  ratings >> farthest >> variance;
  CHECK(variance > 0.0);
  CHECK(farthest < 4.0 * std::sqrt(variance / (9.0 * 75.0)));
}

TEST_CASE("when an interval begins and ends says nothing of what is in it", "[end_to_end]") {
  const TempDirectory directory;
  std::string text =
      testing::replaced(testing::contents(testing::source("tests/data/same_alternatives.yaml")),
                        "other: {plate: held, material: mdf, technique: sinusoid}",
                        "other: {plate: held, material: mdf, technique: fem}");
  text = testing::replaced(
      with_blocks(text,
                  "  - {name: odd, task: odd_one_out, question: Odd, stimuli: [one, other], "
                  "repetitions: 10, explore: {intervals: {seconds: 0.8, gap_seconds: 0.2}}}\n"),
      ", reality: sinusoid, reference: one", "");
  testing::write(directory / "study.yaml", text);
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "2", "--seed",
                             "4", "--out", directory / "study"})
              .exit_code == 0);
  // as long, whichever of the two is in it; how long a gap is depends on the finger alone, which
  // feels nothing yet of the next
  const std::string timed =
      "WITH timed AS (SELECT kind, lead(t_s) OVER trial - t_s AS lasted, lead(value, kind = "
      "'interval_end') OVER trial AS place, trial_id FROM event WHERE kind LIKE 'interval%' "
      "WINDOW trial AS (PARTITION BY trial_id ORDER BY t_s)), of AS (SELECT kind, lasted, stimulus "
      "FROM timed JOIN alternative ON alternative.trial_id = timed.trial_id AND position = place "
      "WHERE lasted IS NOT NULL) ";
  CHECK(sql(directory, timed + "SELECT count(DISTINCT stimulus), count(DISTINCT round(lasted, 1)), "
                               "min(round(lasted, 1)) FROM of WHERE kind = 'interval'") ==
        "2 1 0.8\n");
  std::istringstream gaps{
      sql(directory, timed + "SELECT min(lasted), max(mean) - min(mean), max(error) FROM of JOIN "
                             "(SELECT stimulus, avg(lasted) AS mean, sqrt((avg(lasted * lasted) - "
                             "avg(lasted) * avg(lasted)) / count(*)) AS error FROM of WHERE kind = "
                             "'interval_end' GROUP BY stimulus) WHERE kind = 'interval_end'")};
  double shortest_s = 0.0;
  double difference_s = 1.0;
  double error_s = 0.0;
  gaps >> shortest_s >> difference_s >> error_s;
  CHECK(shortest_s >= 0.2);
  CHECK(difference_s < 4.0 * std::sqrt(2.0) * error_s);
}

TEST_CASE("two of the same are called different in one of six cases, the simulated criterion",
          "[end_to_end][slow]") {
  const TempDirectory directory;
  const std::string study = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  const std::size_t blocks = study.find("blocks:\n") + std::strlen("blocks:\n");
  testing::write(
      directory / "study.yaml",
      study.substr(0, blocks) +
          "  - {name: same_different, task: same_different, question: \"Same?\", stimuli: "
          "[one, other], repetitions: 60}\n" +
          testing::replaced(study.substr(study.find("simulation:")), ", reference: one", ""));
  const auto run = testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "40",
                                      "--seed", "4", "--no-traces", "--out", directory / "study"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream rows{sql(directory,
                              "SELECT avg(response = 'different') FROM current_response "
                              "JOIN trial USING (trial_id) GROUP BY session_id")};
  std::vector<double> rates;
  for (double rate = 0.0; rows >> rate;) {
    rates.push_back(rate);
  }
  REQUIRE(rates.size() == 40);
  double mean = 0.0;
  double squares = 0.0;
  for (const double rate : rates) {
    mean += rate / 40.0;
  }
  for (const double rate : rates) {
    squares += (rate - mean) * (rate - mean) / 39.0;
  }
  // criteria, learned from a few taps, differ between participants
  CHECK(mean == Approx(1.0 / 6.0).margin(4.0 * std::sqrt(squares / 40.0)));
  CHECK(std::sqrt(squares) < 0.1);
}

TEST_CASE("who feels almost without noise mostly ranks first what is the reference itself",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string text =
      testing::contents(testing::source("protocols/examples/techniques_compared.yaml"));
  testing::write(directory / "study.yaml",
                 testing::replaced(text, "observer: {reference: finite_elements}",
                                   "observer: {reference: finite_elements, noise_db: 0.01}"));
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "6", "--seed",
                             "4", "--out", directory / "study"})
              .exit_code == 0);
  // of 12 rankings; the hand still taps a little differently each time
  CHECK(std::stoi(sql(directory,
                      "SELECT count(*) FROM current_response JOIN trial USING (trial_id) "
                      "WHERE block = 'ranking' AND response LIKE 'finite_elements %'")) >= 9);
}

TEST_CASE("a ranking is typed as labels in order, and corrected as their places", "[end_to_end]") {
  const TempDirectory directory;
  std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto first = text.find("blocks:\n") + std::string_view{"blocks:\n"}.size();
  const auto block = text.find("  - {name: ranking");
  text.erase(first, block - first);
  const auto rest = text.find('\n', first) + 1;
  text.erase(rest, text.find("simulation:") - rest);
  testing::write(directory / "study.yaml", text);
  const auto result = session(directory, directory / "study.yaml",
                              "A\n= A\nB\nC\n= A B\n= A B B\nD\n= c a b\n"
                              "A\nB\nC\ncorrect 1 2\ncorrect 2 1 3\n= A B C\n");
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.standard_error,
             Contains("= A B C: your order, the first one first.") &&
                 Contains("please type A, B, C to feel one, = and all labels in order, or quit") &&
                 Contains("please type correct and all numbers from 1 to 3 in order") &&
                 Contains("your last answer is now B A C"));
  const auto stimuli_of = [&](const std::string& labels) {
    return sql(directory,
               "SELECT group_concat(stimulus, ' ') FROM (SELECT stimulus FROM alternative WHERE "
               "trial_id = 1 ORDER BY instr('" +
                   labels + "', label))");
  };
  CHECK(sql(directory, "SELECT response FROM response WHERE trial_id = 1 ORDER BY rowid") ==
        stimuli_of("CAB") + stimuli_of("BAC"));
  CHECK(sql(directory, "SELECT count(*) FROM current_response") == "2\n");
}

TEST_CASE("at the terminal alternatives come by themselves, and again where the protocol allows it",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(
      file,
      testing::replaced(
          testing::replaced(testing::contents(testing::source("tests/data/same_alternatives.yaml")),
                            "stimuli: [family]\n",
                            "stimuli: [family]\n    explore: {intervals: {seconds: 0.8, "
                            "gap_seconds: 0.2, max_replays: 1}}\n"),
          "repetitions: 240", "repetitions: 3"));
  const auto result = session(directory, file, "A\nagain\nagain\n= A\n= B\nquit\n");
  INFO(result.standard_error);
  CHECK_THAT(result.standard_error,
             Contains("come one after the other, for 0.8 s each") && Contains("now A: tap it") &&
                 Contains("now B: tap it") && Contains("your answer, or again (left: 1)") &&
                 Contains("please type = and a label to choose it, or quit") &&
                 Contains("they do not come again"));
  CHECK(sql(directory, "SELECT group_concat(response, '') FROM response") == "AB\n");
  CHECK(sql(directory,
            "SELECT group_concat(kind || round(value), ' ') FROM event WHERE trial_id = 1 AND "
            "kind LIKE 'interval%'") ==
        "interval0.0 interval_end0.0 interval1.0 interval_end1.0 interval_replay1.0 "
        "interval0.0 interval_end0.0 interval1.0 interval_end1.0\n");
  // nothing is felt out of an interval once the finger has left the plate
  CHECK(sql(directory,
            "SELECT count(*) FROM event AS felt WHERE kind = 'contact' AND (SELECT kind FROM event "
            "AS told WHERE told.trial_id = felt.trial_id AND told.t_s < felt.t_s AND "
            "(told.kind LIKE 'interval%') ORDER BY t_s DESC LIMIT 1) IS NOT 'interval' AND NOT "
            "EXISTS (SELECT 1 FROM event AS over WHERE over.trial_id = felt.trial_id AND over.kind "
            "= 'interval_end' AND felt.t_s - over.t_s BETWEEN 0 AND 0.02)") == "0\n");
  CHECK(testing::tapstudy({"verify", directory / "study"}).exit_code == 0);
}

TEST_CASE("intervals are refused where a trial has one alternative or one that is changed",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  const std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  for (const auto* const task : {"adjustment", "rating"}) {
    const std::string free = "explore: {min_contacts: 0}";
    std::string changed = text;
    changed.replace(text.find(free, text.find(fmt::format("task: {}", task))), free.size(),
                    "explore: {intervals: {seconds: 1}}");
    testing::write(file, changed);
    const auto result = testing::tapstudy({"check", file});
    CAPTURE(task);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.standard_error,
               Contains("explore: intervals: the alternatives of " + std::string{task}));
  }
}

TEST_CASE("a magnitude does not depend on the name of what was felt", "[end_to_end][slow]") {
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  std::string text = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  const auto first = text.find("  - name: comparison");
  text.erase(first, text.find("  - {name: magnitude") - first);
  testing::write(file, testing::replaced(text, ", reference: one", ""));
  REQUIRE(testing::tapstudy({"simulate", file, "--participants", "9", "--seed", "4", "--out",
                             directory / "study"})
              .exit_code == 0);
  std::istringstream rows{
      sql(directory,
          "SELECT count(*), avg(m), avg(m * m) FROM (SELECT stimulus, log(response) AS m "
          "FROM current_response JOIN trial USING (trial_id) JOIN alternative USING (trial_id) "
          "WHERE block = 'magnitude' AND position = 1) GROUP BY stimulus")};
  std::vector<double> means;
  double variance = 0.0;
  double count = 0.0;
  double mean = 0.0;
  double square = 0.0;
  while (rows >> count >> mean >> square) {
    CHECK(count == 9 * 120);
    means.push_back(mean);
    variance += (square - mean * mean) / count;
  }
  REQUIRE(means.size() == 2);
  CHECK(variance > 0.0);
  CHECK(means[0] == Approx(means[1]).margin(4.0 * std::sqrt(variance)));
  // as strong as the modulus, which it is: the mean of the logarithms is that of 10
  CHECK(means[0] == Approx(1.0).margin(4.0 * std::sqrt(variance)));
}

TEST_CASE("a stronger sinusoid is estimated higher by who only feels it", "[end_to_end][slow]") {
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  std::string text = testing::contents(testing::source("tests/data/same_alternatives.yaml"));
  text = with_blocks(text,
                     "  - {name: strength, task: magnitude, question: Strong, stimuli: [family], "
                     "values: [0.06, 0.6, 6], repetitions: 20}\n");
  text = testing::replaced(text, "{from: 3, to: 6}", "{from: 0.06, to: 6}");
  testing::write(file, testing::replaced(text, ", reference: one", ""));
  REQUIRE(testing::tapstudy({"simulate", file, "--participants", "6", "--seed", "3", "--out",
                             directory / "study"})
              .exit_code == 0);
  const auto report =
      testing::tapstudy({"report", directory / "study", "--out", directory / "report"});
  INFO(report.standard_output << report.standard_error);
  REQUIRE(report.exit_code == 0);
  std::istringstream rows{
      sql(directory,
          "SELECT avg(log(response)) FROM current_response JOIN trial USING (trial_id) "
          "JOIN axis_value USING (trial_id) GROUP BY value ORDER BY value")};
  std::vector<double> means(3);
  rows >> means[0] >> means[1] >> means[2];
  CHECK(means[0] < means[1]);
  CHECK(means[1] < means[2]);
  CHECK_THAT(report.standard_output, Contains("power law"));
}

TEST_CASE("what is no magnitude is refused in words and asked for again", "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto first = text.find("  - name: comparison");
  text.erase(first, text.find("  - {name: magnitude") - first);
  testing::write(file, testing::replaced(text, ", reference: one", ""));
  const auto result = session(directory, file,
                              "0\n-3\nnan\ninf\n1e9\ntwelve\n" + std::string(1000, '9') +
                                  "\n12.50\ncorrect x\ncorrect 13\na\nb\n0\n7\n");
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(sql(directory, "SELECT response FROM current_response ORDER BY trial_id") == "13\n7\n");
  const std::string& said = result.standard_error;
  std::size_t refusals = 0;
  for (auto at = said.find("please type a number above 0"); at != std::string::npos;
       at = said.find("please type a number above 0", at + 1)) {
    ++refusals;
  }
  CHECK(refusals == 7);
  CHECK_THAT(said, Contains("A is 10") && Contains("please type correct and a number above 0"));
}

namespace {
// The study of every task with these blocks instead.
std::string study_of(const TempDirectory& directory, const std::string& blocks,
                     const std::string& observer = "noise_db: 3, reality: sinusoid") {
  const std::string file = directory / "study.yaml";
  std::string text = testing::contents(testing::source("tests/data/every_task.yaml"));
  const auto first = text.find("blocks:");
  text.replace(first, text.find("simulation:") - first, "blocks:\n" + blocks);
  text = testing::replaced(text, "{from: 3, to: 6}", "{from: 0.06, to: 6}");
  testing::write(
      file, testing::replaced(text, "noise_db: 3, reality: sinusoid, reference: one", observer));
  return file;
}
std::string adjustment(const std::string& name, const std::string& to, int repetitions) {
  return fmt::format(
      "  - {{name: {}, task: adjustment, question: Equal, stimuli: [family], settings: {{from: "
      "0.6, to: 6, count: 11, spacing: log}}, {}, repetitions: {}, explore: {{min_contacts: "
      "0}}}}\n",
      name, to, repetitions);
}
}  // namespace

TEST_CASE("who has no noise adjusts to what is equal, by feeling it", "[end_to_end][slow]") {
  const TempDirectory directory;
  std::string file = study_of(directory,
                              adjustment("low", "standard: 1.19715738898", 4) +
                                  adjustment("high", "standard: 3.78574406688", 4),
                              "noise_db: 0, reality: sinusoid");
  testing::write(file,
                 testing::replaced(testing::contents(file), "taps_per_visit: 1, visits: 1",
                                   "taps_per_visit: 6, visits: 1, scatter_m: 0, speed_spread: 0"));
  const auto result = testing::tapstudy(
      {"simulate", file, "--participants", "6", "--seed", "4", "--out", directory / "study"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  // taps differ all the same; of a guess one in eleven would be the standard
  for (const char* const block : {"low", "high"}) {
    const std::string of_block = fmt::format(
        " FROM current_response JOIN trial USING (trial_id) "
        "WHERE block = '{}'",
        block);
    CAPTURE(block, sql(directory, "SELECT response, count(*)" + of_block + " GROUP BY 1"));
    CHECK(std::stod(sql(directory, "SELECT count(*)" + of_block)) == 24);
    CHECK(std::stod(sql(directory,
                        "SELECT avg(abs(response - (SELECT value FROM axis_value WHERE "
                        "axis_value.trial_id = trial.trial_id AND position = 0)) < "
                        "1e-6)" +
                            of_block)) > 0.7);
  }
  // the answer is the last setting
  CHECK(sql(directory,
            "SELECT max(abs(response - (SELECT value FROM event WHERE event.trial_id = "
            "trial.trial_id AND kind = 'setting' ORDER BY rowid DESC LIMIT 1))) "
            "FROM trial JOIN current_response USING (trial_id)") == "0.0\n");
  const auto verified = testing::tapstudy({"verify", directory / "study"});
  INFO(verified.standard_output << verified.standard_error);
  CHECK(verified.exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "study"});
  INFO(report.standard_error);
  CHECK(report.exit_code == 0);
  CHECK_THAT(report.standard_output,
             Contains("point of subjective equality") && Contains("ascending over descending"));
}

TEST_CASE("a setting does not depend on the name of the standard", "[end_to_end][slow]") {
  const TempDirectory directory;
  std::string file = study_of(directory, adjustment("first", "reference: one", 20) +
                                             adjustment("second", "reference: other", 20));
  testing::write(
      file, testing::replaced(testing::contents(file), "technique: none", "technique: sinusoid"));
  REQUIRE(testing::tapstudy({"simulate", file, "--participants", "9", "--seed", "4", "--out",
                             directory / "study"})
              .exit_code == 0);
  std::istringstream rows{
      sql(directory,
          "SELECT count(*), avg(m), avg(m * m) FROM (SELECT block, log(response) AS m "
          "FROM current_response JOIN trial USING (trial_id)) GROUP BY block")};
  std::vector<double> means;
  double variance = 0.0;
  double count = 0.0;
  double mean = 0.0;
  double square = 0.0;
  while (rows >> count >> mean >> square) {
    CHECK(count == 9 * 20);
    means.push_back(mean);
    variance += (square - mean * mean) / count;
  }
  REQUIRE(means.size() == 2);
  CHECK(variance > 0.0);
  CHECK(means[0] == Approx(means[1]).margin(4.0 * std::sqrt(variance)));
}

TEST_CASE("at the terminal + and - move the stimulus, = answers as it is set, each is stored",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string file = study_of(directory, adjustment("strength", "standard: 3", 1));
  const auto result =
      session(directory, file, "a\nb\n" + std::string(30, '-') + "\n-\n7\n+++\n-\n+-\n = \n");
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
  // from the lowest of 11 values over a decade three up and one down
  const double expected = 0.6 * std::pow(10.0, 2.0 * 0.1);
  CHECK(std::stod(sql(directory, "SELECT response FROM current_response")) ==
        Approx(expected).epsilon(1e-6));
  CHECK(sql(directory, "SELECT count(*) FROM event WHERE kind = 'setting'") == "4\n");
  CHECK(sql(directory, "SELECT count(*), count(DISTINCT label) FROM alternative") == "12 2\n");
  CHECK_THAT(result.standard_error, Contains("B is at its limit in that direction") &&
                                        Contains("+ or - to change B, = when it is set"));
  const auto verified = testing::tapstudy({"verify", directory / "study"});
  INFO(verified.standard_output << verified.standard_error);
  CHECK(verified.exit_code == 0);
}

TEST_CASE("a staircase in a session goes down after right answers and up after a wrong one",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string study = staircase_study(directory, staircase);
  // always A: right where the comparison is A
  std::string input;
  for (int trial = 0; trial < 8; ++trial) {
    input += "a\nb\n= a\n";
  }
  const auto result = session(directory, study, input);
  INFO(result.standard_error);
  std::istringstream rows{
      sql(directory,
          "SELECT is_correct, (SELECT round(value / 3 - 1, 6) FROM axis_value AS v "
          "JOIN alternative AS a USING (trial_id, position) WHERE a.is_comparison "
          "AND v.trial_id = trial.trial_id) FROM trial JOIN response USING (trial_id) "
          "WHERE block = 'comparison' ORDER BY trial_id")};
  double expected = 0.8;
  double step = 0.4;
  int row = 0;
  int direction = 0;
  int trials = 0;
  bool is_right = false;
  double level = 0.0;
  while (rows >> is_right >> level) {
    CAPTURE(trials);
    CHECK(level == Approx(expected).margin(1e-6));
    row = is_right ? row + 1 : 0;
    const int turn = row == 2 ? -1 : is_right ? 0 : 1;
    if (turn != 0) {
      step = direction != 0 && turn != direction ? std::max(0.1, step / 2.0) : step;
      direction = turn;
      row = 0;
      expected = std::clamp(expected + turn * step, 0.0, 1.0);
    }
    ++trials;
  }
  CHECK(trials == 8);
}

TEST_CASE("a skipped trial costs its procedure no answer, also where the session is resumed",
          "[end_to_end][threads]") {
  const bool is_resumed = GENERATE(false, true);
  const std::string answer = "a\nb\n= a\n";
  const TempDirectory directory;
  const std::string study = staircase_study(directory, staircase);
  std::string rest;
  for (int trial = 0; trial < 7; ++trial) {
    rest += answer;
  }
  const std::string first = answer + "a\n:skip\n";
  if (is_resumed) {
    session(directory, study, first);
    session(directory, study, rest, {"--resume"});
  } else {
    session(directory, study, first + rest);
  }
  CHECK(sql(directory,
            "SELECT count(*), count(DISTINCT number) FROM trial WHERE status = 'answered'") ==
        "8 8\n");
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE status = 'skipped'") == "1\n");
  CHECK(testing::tapstudy({"verify", directory / "study"}).exit_code == 0);
}

TEST_CASE("a session that is resumed in an adaptive track goes on with the same next stimulus",
          "[end_to_end][threads]") {
  const std::string procedure = GENERATE(false, true) ? psi : staircase;
  const std::string answer = "a\nb\n= a\n";
  const TempDirectory whole;
  const TempDirectory parts;
  const std::string study = staircase_study(whole, procedure);
  std::string all;
  for (int trial = 0; trial < 8; ++trial) {
    all += answer;
  }
  INFO(session(whole, study, all).standard_error);
  session(parts, study, answer + answer + answer);
  session(parts, study, answer + answer, {"--resume"});
  session(parts, study, answer + answer + answer, {"--resume"});
  const std::string uninterrupted = levels(whole);
  CHECK(std::ranges::count(uninterrupted, '\n') == 8);
  CHECK(levels(parts) == uninterrupted);
}

TEST_CASE("every shipped study is simulated, verified and reported", "[end_to_end][slow]") {
  const std::string folder = GENERATE("recommended", "examples");
  int studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator{testing::shipped(folder)}) {
    CAPTURE(entry.path().string());
    if (protocols::read_protocol(entry.path().string()).blocks.empty()) {
      continue;  // plates to tap
    }
    const TempDirectory directory;
    ++studies;
    const auto simulated = testing::tapstudy({"simulate", entry.path().string(), "--participants",
                                              "2", "--seed", "2", "--out", directory / "study"});
    INFO(simulated.standard_error);
    REQUIRE(simulated.exit_code == 0);
    CHECK(sql(directory, "PRAGMA foreign_key_check") == "");
    const auto verified = testing::tapstudy({"verify", directory / "study"});
    INFO(verified.standard_output << verified.standard_error);
    CHECK(verified.exit_code == 0);
    const auto report = testing::tapstudy({"report", directory / "study"});
    INFO(report.standard_error);
    CHECK(report.exit_code == 0);
    CHECK_THAT(report.standard_output, Contains("SIMULATED participants"));
  }
  CHECK(studies >= 3);
}

TEST_CASE("what cannot be compared is refused at its line", "[end_to_end]") {
  const auto [from, to, said] = GENERATE(table<std::string, std::string, std::string>({
      {"values: [0.0]", "values: [0.0, 2.0]",
       "may ask for the level 2, which is sinusoid_amplitude_n_s_per_m = 9"},
      {"values: [0.0]", "values: [-0.5, 0.0]", "levels are at least 0"},
      {"    stimuli: [family]\n", "    stimuli: [one]\n", "which must have `vary`"},
      {"    stimuli: [family]\n", "    stimuli: [family]\n    standard: 2\n", "standard"},
      {"    stimuli: [family]\n", "    stimuli: [family]\n    axis: thickness_m\n",
       "is not a known axis of the stimuli"},
      {"    stimuli: [family]\n", "    stimuli: [family]\n    repetitions: 2\n",
       "is what the procedures make it"},
      {"    procedures:\n      - constant: {values: [0.0], repetitions: 240}\n", "",
       "give procedures, or at least two stimuli"},
      {"stimuli: [one, other], modulus", "stimuli: [family], values: [4, 3], modulus",
       "are not in increasing order"},
      {"stimuli: [one, other], modulus", "stimuli: [family], values: [4, 9], modulus",
       "9 is not allowed (from 3 to 6"},
      {"stimuli: [one, other], modulus",
       "stimuli: [one, other], values: [4], axis: thickness_m, modulus",
       "values are of stimuli that have `vary`"},
      {"task: abx, question: \"Which is X?\", stimuli: [one, other]",
       "task: abx, question: \"Which is X?\", stimuli: [one]", "at least two stimuli"},
      {"stimuli: [one, other, third], repetitions: 25", "stimuli: [one, other], repetitions: 25",
       "among 3 alternatives needs at least as many stimuli"},
      {"stimuli: [one, other, third], repetitions: 25",
       "stimuli: [one, other, other], repetitions: 25", "other"},
      {"stimuli: [one, other, third], repetitions: 25",
       "stimuli: [one, other, third], alternatives: 5", "2 to 4"},
  }));
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(
      file, testing::replaced(
                testing::contents(testing::source("tests/data/same_alternatives.yaml")), from, to));
  const auto result = testing::tapstudy({"check", file});
  CAPTURE(to, result.standard_error);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.standard_error, Contains(said) && Contains("study.yaml:"));
}

TEST_CASE("chance prefers either of two, whether or not ties are allowed", "[end_to_end]") {
  const auto check = testing::tapstudy({"check", testing::source("tests/data/every_task.yaml")});
  REQUIRE(check.exit_code == 0);
  for (const std::string block : {"paired", "paired_or_tied"}) {
    const std::string& said = check.standard_output;
    const std::size_t begin = said.find("  " + block + ": paired, ");
    REQUIRE(begin != std::string::npos);
    CHECK_THAT(said.substr(begin, 150), Contains("chance 50 %; of 10 answers 9 must prefer"));
  }
}

TEST_CASE("check warns of a procedure that assumes another guess rate than the task has",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string jnd = testing::shipped("examples/stiffness_jnd.yaml").string();
  const std::string warning =
      "warning: the procedure's guess rate is 0.333, by chance 0.5 is right";
  CHECK_THAT(testing::tapstudy({"check", jnd}).standard_output, !Contains("guess rate"));
  const std::string other = directory / "other.yaml";
  testing::write(other, testing::replaced(testing::contents(jnd), "guess: {values: [0.5]}",
                                          "guess: {values: [0.333]}"));
  CHECK_THAT(testing::tapstudy({"check", other}).standard_output, Contains(warning));
}

TEST_CASE("a family of an unknown material, plate or technique is refused by its name",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string study = directory / "study.yaml";
  const auto [example, from, to, said] =
      GENERATE(table<std::string, std::string, std::string, std::string>({
          {"stiffness_jnd", "    material: ", "    material: un", "plate.material: 'un"},
          {"stiffness_jnd", "    technique: ", "    technique: un", "plate.technique: 'un"},
          {"hardness_magnitude", "technique: ", "technique: un", ".technique: 'un"},
      }));
  testing::write(
      study, testing::replaced(testing::contents(testing::shipped("examples/" + example + ".yaml")),
                               from, to));
  const auto checked = testing::tapstudy({"check", study});
  INFO(checked.standard_error);
  CHECK(checked.exit_code == 2);
  CHECK_THAT(checked.standard_error, Contains(said));
}

TEST_CASE("fixed stimuli are compared in the order in which they are listed, and the report has d'",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string file = study_of(
      directory,
      "  - {name: fixed, task: comparison, question: Which is stronger, stimuli: [other, one], "
      "alternatives: 3, repetitions: 8, explore: {min_contacts: 0}}\n",
      "noise_db: 1, reality: sinusoid");
  const auto result = testing::tapstudy(
      {"simulate", file, "--participants", "3", "--seed", "4", "--out", directory / "study"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(sql(directory,
            "SELECT count(DISTINCT stimulus), avg(stimulus = 'one') FROM alternative "
            "WHERE is_comparison") == "1 1.0\n");
  CHECK(std::stod(sql(directory, "SELECT avg(is_correct) FROM current_response")) > 0.6);
  CHECK(testing::tapstudy({"verify", directory / "study"}).exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "study"});
  CHECK_THAT(report.standard_output, Contains("forced_choice") && Contains("d' (95 % CI)") &&
                                         Contains("each right equally often"));
}
