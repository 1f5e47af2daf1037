// Practice to a criterion, real plates, a factor that is asked for, catch trials, corrections.
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
const std::string study = testing::source("tests/data/material_study.yaml");

testing::ProgramResult session(const TempDirectory& directory, const std::string& input,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"run", study, "--participant", "P01", "--out", directory / "study"};
  line.insert(line.end(), more.begin(), more.end());
  return testing::tapstudy(line, input);
}
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "study") + "/study.db", query})
      .standard_output;
}
const std::string practised = "2\n2\n2\n2\n1\n";  // right is every second, then two in a row
const std::string controlled =
    "ready\nmounted\n1\nready\nmounted\n2\n";  // each plate is mounted first
}  // namespace

TEST_CASE("practice ends with the answer that meets its criterion", "[end_to_end][threads]") {
  const TempDirectory directory;
  session(directory, "1\n2\n");
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE is_practice AND status = 'answered'") ==
        "2\n");
  CHECK(sql(directory, "SELECT detail FROM session_event WHERE state = 'practised'") ==
        "practice: met, 2 of the last 2 right\n");
  CHECK(sql(directory, "SELECT max(number) FROM session_event") == "7\n");  // the next block
  session(directory, "\n1\n", {"--resume"});
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE is_practice AND status = 'answered'") ==
        "2\n");  // in a later session too
}

TEST_CASE(
    "a corrected practice answer changes nothing of how well was practised, nor a resumed "
    "session the language",
    "[end_to_end][threads]") {
  const TempDirectory directory;
  const std::string loose = directory / "loose.yaml";
  testing::write(loose, testing::replaced(testing::contents(study), "    criterion:",
                                          "    correction: true\n    criterion:"));
  const auto run = [&](const std::string& input, const std::vector<std::string>& more) {
    std::vector<std::string> line{"run", loose,   "--participant",
                                  "P01", "--out", directory / "study"};
    line.insert(line.end(), more.begin(), more.end());
    return testing::tapstudy(line, input);
  };
  // met with the second answer, which is corrected to a wrong one in the next trial
  run("1\n2\n:correct 1\n\n1\n", {"--language", "de"});
  run("\n2\n", {"--resume"});
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE is_practice") == "2\n");
  CHECK(sql(directory, "SELECT group_concat(language) FROM session") == "de,de\n");
}

TEST_CASE("practice is judged once it was presented, in whatever order the blocks come",
          "[end_to_end]") {
  const auto block = [](const std::string& name, const std::string& more) {
    return "  - {name: " + name +
           ", task: identification, question: Which, stimuli: [bare, ringing], repetitions: 2" +
           more + "}\n";
  };
  const std::string practice =
      ", practice: true, criterion: {correct: 1, of_last: 4, otherwise: end}";
  const std::string text = R"(format: tapstudy/1
title: Two blocks, each with its practice
finger: {mass_kg: 0.058, stiffness_n_per_m: 300, damping_n_s_per_m: 3}
rendering: {rate_hz: 1000, band_limit_hz: 300, penalty_stiffness_n_per_m: 3000, sinusoid: {amplitude_n_s_per_m: 3, decay_per_s: 600, frequency_hz: 250}}
placement: {origin_m: [0, 0, 0], lateral_scale: 0.1}
materials:
  mdf: {youngs_modulus_pa: 2.5e9, density_kg_per_m3: 610, poissons_ratio: 0.25, damping: {ratio: 0.02}}
plates:
  held: {size_m: [0.6, 0.6, 0.05], mesh: {order: 1}, fixations: [{region: disc, at_m: [0.25, 0.25], radius_m: 0.02}]}
tapping_points_m: {middle: [0, 0]}
stimuli:
  bare: {label: bare, plate: held, material: mdf, technique: none}
  ringing: {label: ringing, plate: held, material: mdf, technique: sinusoid}
block_order: {order: shuffle}
blocks:
)" + block("practice_a", practice) +
                           block("a", "") + block("practice_b", practice) + block("b", "");
  const TempDirectory directory;
  testing::write(directory / "study.yaml", text);
  std::string everything;  // "1" is right half of the time
  for (int i = 0; i < 40; ++i) {
    everything += "1\n";
  }
  for (const char* const seed : {"1", "2", "3", "4"}) {  // some begin with b
    const auto run =
        testing::tapstudy({"run", directory / "study.yaml", "--participant",
                           std::string{"P"} + seed, "--seed", seed, "--out", directory / "study"},
                          everything);
    INFO(run.standard_error);
    CHECK(run.exit_code == 0);
  }
  CHECK(sql(directory,
            "SELECT count(DISTINCT block) FROM session_event AS event JOIN trial "
            "ON trial.session_id = event.session_id AND trial.number = 1 "
            "WHERE event.state = 'ended'") == "2\n");
  CHECK(sql(directory,
            "SELECT count(*) FROM session_event WHERE state = 'practised' "
            "AND detail LIKE '%: met, 2 of the last 4 right'") == "8\n");
}

TEST_CASE("catch trials, labels and corrections that contradict are refused at their line",
          "[end_to_end]") {
  const auto [from, to, said] = GENERATE(table<std::string, std::string, std::string>({
      {"expected: {hard_held: acrylic}", "expected: {}", "catch_trials.expected: "},
      {"expected: {hard_held: acrylic}", "expected: {hard_held: mdf}", "where 'acrylic' is right"},
      {"expected: {hard_held: acrylic}", "expected: {hard_held: oak}", "cannot be answered"},
      {"mdf: {en: wood fibre, de: Holzfaser}", "mdf: acrylic", "have the same label"},
      {"    criterion:", "    feedback: true\n    correction: true\n    criterion:",
       "cannot be combined with feedback"},
      {"correct: 2, of_last: 2", "correct: 3, of_last: 2", "no 3 can be right"},
      {"    presented: real\n", "    presented: real\n    explore: {min_contacts: 1}\n",
       "contacts are not measured"},
      {"{en: \"Which plate is it?\", de:", "{english: \"Which plate is it?\", de:",
       "is not a language"},
  }));
  const TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(file, testing::replaced(testing::contents(study), from, to));
  const auto result = testing::tapstudy({"check", file});
  CAPTURE(to, result.standard_error);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.standard_error, Contains(said) && Contains("study.yaml:"));
}

TEST_CASE("a simulated participant who misses a criterion that had to be met leaves the study",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string hard = directory / "hard.yaml";
  testing::write(hard, testing::replaced(testing::contents(study), "correct: 2, of_last: 2",
                                         "correct: 6, of_last: 6"));
  const auto result = testing::tapstudy(
      {"simulate", hard, "--participants", "8", "--seed", "3", "--out", directory / "study"});
  REQUIRE(result.exit_code == 0);
  CHECK(sql(directory, "SELECT count(DISTINCT session_id) FROM trial WHERE is_practice") == "8\n");
  // who stays has answered all six right, and nobody else
  CHECK(sql(directory,
            "SELECT count(*) FROM (SELECT session_id FROM trial "
            "JOIN current_response USING (trial_id) GROUP BY session_id "
            "HAVING (sum(is_practice AND is_correct) = 6) <> (max(is_practice = 0) = 1))") ==
        "0\n");
}

TEST_CASE("a session ends where a criterion that had to be met was not", "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "2\n1\n2\n1\n2\n1\n");
  CHECK(result.exit_code == 130);
  CHECK_THAT(result.standard_error, Contains("practice: not met, 0 of the last 2 right"));
  CHECK(session(directory, "", {"--resume"}).exit_code == 130);
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE NOT is_practice") == "0\n");
}

TEST_CASE("the whole study is stored: real plates as real, catch trials as such, corrections",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result =
      session(directory, practised + controlled + "1\n1\ncorrect 2\ncorrect 9\n1\n2\n2\n",
              {"--language", "de"});
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("Welche Platte ist es?") && Contains("Holzfaser"));
  CHECK_THAT(result.standard_error, Contains("mount the real plate 'soft_small'"));
  CHECK_THAT(result.standard_output, Contains("all 12 trials"));  // one practice trial not needed
  CHECK(sql(directory,
            "SELECT block, presented, count(*) FROM trial GROUP BY block, presented "
            "ORDER BY min(number)") == "practice|virtual|5\ncontrol|real|2\nmaterial|virtual|5\n");
  CHECK(sql(directory,
            "SELECT sum(ticks) FROM tick_statistics JOIN trial USING (trial_id) "
            "WHERE presented = 'real'") == "0\n");
  CHECK(sql(directory, "SELECT count(*) FROM trial WHERE is_catch AND block = 'material'") ==
        "1\n");
  CHECK(sql(directory,
            "SELECT number, response, given_by FROM current_response "
            "JOIN trial USING (trial_id) WHERE supersedes IS NOT NULL") ==
        "10|acrylic|participant\n");
  CHECK(sql(directory, "SELECT language FROM session") == "de\n");
  const auto journal = testing::contents((directory / "study") + "/answers.journal");
  CHECK_THAT(journal, Contains("\"is_of_real_plate\":true") && Contains("\"is_catch\":true") &&
                          Contains("\"given_by\":\"participant\""));
}

TEST_CASE("a factor that is asked for is reported as a matrix of stimuli by levels",
          "[end_to_end]") {
  const TempDirectory directory;
  const std::string easy = directory / "easy.yaml";
  testing::write(easy,
                 testing::replaced(testing::contents(study), "otherwise: end", "otherwise: go_on"));
  REQUIRE(testing::tapstudy({"simulate", easy, "--participants", "2", "--seed", "1", "--out",
                             directory / "study"})
              .exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "study"});
  INFO(report.standard_output + report.standard_error);
  REQUIRE(report.exit_code == 0);
  const auto table = testing::contents((directory / "study") + "/report/material_confusion.csv");
  CHECK_THAT(table, Contains(",mdf,acrylic\n") && Contains("soft_held"));
  // four ordinary trials of each of two participants; the catch trial is in no result
  CHECK(sql(directory,
            "SELECT sum(is_correct) FROM current_response JOIN trial USING (trial_id) "
            "WHERE block = 'material' AND NOT is_catch AND response = CASE WHEN "
            "(SELECT stimulus FROM alternative AS a WHERE a.trial_id = trial.trial_id) "
            "LIKE 'soft%' THEN 'mdf' ELSE 'acrylic' END") ==
        sql(directory,
            "SELECT sum(is_correct) FROM current_response JOIN trial USING (trial_id) "
            "WHERE block = 'material' AND NOT is_catch"));
  CHECK_THAT(report.standard_output,
             Contains("/8 = ") && Contains("chance 50 %") && Contains("real plates"));
}
