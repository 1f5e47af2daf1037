// What a report says of a study besides its blocks.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "results/store/store.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// Each participant marks every line of the task's load at a tenth of their session's id.
void answer_forms(const std::string& study) {
  results::Store store =
      results::Store::open_or_create(study, results::Store::open_existing(study).study());
  for (const results::SessionRow& session : store.sessions()) {
    std::vector<results::FormAnswerRow> answers;
    for (const char* scale : {"mental_demand", "physical_demand", "temporal_demand", "performance",
                              "effort", "frustration"}) {
      answers.push_back({session.id, 1.0, "load", "session end", scale,
                         fmt::format("{:.1f}", 0.1 * static_cast<double>(session.id))});
    }
    answers.push_back({session.id, 1.0, "about", "session begin", "why", "because of a secret"});
    store.add_form(answers);
  }
}
}  // namespace

TEST_CASE("a report has each participant's sessions and the load of the task",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string protocol = directory / "study.yaml";
  testing::write(protocol, testing::contents(testing::shipped("paper/discrimination.yaml")) +
                               "\nforms:\n  load: {shipped: nasa_tlx}\n"
                               "  about:\n    title: You\n    items:\n"
                               "      - {name: why, kind: text, question: \"Why?\"}\n"
                               "forms_before: [about]\nforms_after: [load]\n");
  const std::string study = directory / "study";
  const auto simulated = testing::tapstudy(
      {"simulate", protocol, "--participants", "4", "--seed", "1", "--out", study});
  INFO(simulated.standard_error);
  REQUIRE(simulated.exit_code == 0);
  answer_forms(study);
  const auto report = testing::tapstudy({"report", study, "--out", directory / "report"});
  INFO(report.standard_error);
  REQUIRE(report.exit_code == 0);
  CHECK_THAT(report.standard_output, !Contains("How the sessions went"));  // the page says it
  CHECK_THAT(report.standard_output, !Contains("secret"));
  const std::string text = testing::contents((directory / "report") + "/report.json");
  CHECK_THAT(text, !Contains("secret"));
  const auto json = nlohmann::json::parse(text).at("study");
  REQUIRE(json.at("course").size() == 4);
  CHECK(json.at("course").at(0).at("mode") == "simulated");
  CHECK(json.at("course").at(0).at("answered") == 8);
  const auto& load = json.at("questionnaire_scores").at(0);
  CHECK(load.at("scored") == 4);
  CHECK(load.at("mean").get<double>() == Approx(25.0));  // of 10, 20, 30 and 40
  CHECK_THAT(testing::contents((directory / "report") + "/course.csv"),
             Contains("participant,mode,sessions,answered"));
}

TEST_CASE("the methods of a report name the procedures that chose the levels",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const auto methods_of = [&](const std::string& example) {
    const std::string study = directory / example;
    REQUIRE(
        testing::tapstudy({"simulate", testing::shipped("examples/" + example + ".yaml").string(),
                           "--participants", "1", "--no-traces", "--out", study})
            .exit_code == 0);
    REQUIRE(testing::tapstudy({"report", study, "--out", study + "_report"}).exit_code == 0);
    return testing::contents(study + "_report/report.html");
  };
  CHECK_THAT(methods_of("stiffness_jnd"),
             Contains("levels of Young's modulus by") && Contains("QUEST+ (Watson 2017)"));
  CHECK_THAT(methods_of("damping_jnd"), Contains("levels of damping scale by") &&
                                            Contains("staircase") && Contains("settles at"));
}

TEST_CASE("the methods of a report say what the protocol asked for and what it ran on",
          "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "study";
  std::string latest;
  const auto methods_of = [&](const std::string& protocol) {
    testing::write(directory / "study.yaml", protocol);
    const std::string out = study + std::to_string(protocol.size());
    latest = out;
    REQUIRE(testing::tapstudy({"run", directory / "study.yaml", "--participant", "P01", "--seed",
                               "5", "--out", out},
                              "1\n2\n3\n4\n1\n2\n3\n4\n")
                .exit_code == 0);
    REQUIRE(testing::tapstudy({"report", out, "--out", out + "_report"}).exit_code == 0);
    return testing::contents(out + "_report/report.html");
  };
  const std::string plain = testing::contents(testing::shipped("paper/discrimination.yaml"));
  const std::string text = methods_of(plain);
  CHECK_THAT(text, Contains("1 participant (pilot). Apparatus: "));
  CHECK_THAT(text, Contains("a spring of 3000 N/m with the technique fem; modes of vibration up to "
                            "300 Hz"));
  CHECK_THAT(text, Contains("(identification of 4 stimuli, 8 trials, in random order)"));
  CHECK_THAT(text, Contains("An answer required at least 1 contact. "));
  CHECK_THAT(text, Contains("page, where it was open, showed what was presented"));
  CHECK_THAT(text, !Contains("Masking"));
  const std::string masked = methods_of(plain +
                                        "\nmasking: {kind: pink, level_db_fs: -24}\n"
                                        "display: {blind_operator: true}\n");
  CHECK_THAT(masked, Contains("Masking: the protocol asks for pink noise at -24 dB FS") &&
                         Contains("none was played"));
  CHECK_THAT(testing::contents(latest + "_report/masking.csv"), Contains("P01,0,8,"));
  CHECK_THAT(masked, Contains("page, where it was open, did not show what was presented"));
  CHECK_THAT(masked, !Contains("letters"));
}

TEST_CASE(
    "a block that is called as a part of the report is keeps its tables apart from that part's",
    "[end_to_end][report]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "study";
  testing::write(directory / "study.yaml",
                 testing::replaced(testing::contents(testing::source("tests/data/every_task.yaml")),
                                   "name: rating,", "name: rendered,"));
  REQUIRE(testing::tapstudy({"simulate", directory / "study.yaml", "--participants", "1", "--seed",
                             "1", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  CHECK_THAT(testing::contents(study + "/report/rendered_stimuli.csv"), Contains("fixation"));
  CHECK_THAT(testing::contents(study + "/report/block_rendered_stimuli.csv"), Contains("median"));
}

// A study that was run on several machines, each with a store of its own.
using testing::TempDirectory;

namespace {
void run(const std::string& protocol, const std::string& participant, const std::string& out,
         const std::string& answers) {
  const auto session = testing::tapstudy({"run", protocol, "--participant", participant, "--seed",
                                          participant == "P01" ? "5" : "6", "--out", out},
                                         answers);
  INFO(session.standard_error);
  REQUIRE(session.exit_code == 0);
}
testing::ProgramResult report(const TempDirectory& directory,
                              const std::vector<std::string>& studies, const std::string& out) {
  std::vector<std::string> line{"report", "--out", directory / out};
  for (const std::string& study : studies) {
    line.push_back(directory / study);
  }
  return testing::tapstudy(line);
}
// What does not depend on how fast the hand tapped and the program answered.
nlohmann::json answered(const TempDirectory& directory, const std::string& out) {
  nlohmann::json block =
      nlohmann::json::parse(testing::contents((directory / out) + "/report.json"))
          .at("blocks")
          .at(0);
  for (const char* const timed :
       {"response_times", "conditional_accuracy", "balanced_integration", "exploration"}) {
    REQUIRE(block.erase(timed) == 1);
  }
  return block;
}
const std::string first = "1\n2\n3\n4\n1\n2\n3\n4\n";
const std::string second = "4\n4\n3\n1\n1\n2\n2\n4\n";
}  // namespace

TEST_CASE("participants of two rigs are reported as if all had sat at one",
          "[end_to_end][report]") {
  const TempDirectory directory;
  const std::string study = testing::shipped("paper/discrimination.yaml").string();
  run(study, "P01", directory / "left", first);
  const std::string as_written_there = directory / "formatted.yaml";
  testing::write(as_written_there, testing::replaced(testing::contents(study), "mass_kg: 0.058",
                                                     "\"mass_kg\": 5.80e-2"));
  run(as_written_there, "P02", directory / "right", second);
  run(study, "P01", directory / "one", first);
  run(study, "P02", directory / "one", second);
  REQUIRE(report(directory, {"left", "right"}, "merged").exit_code == 0);
  REQUIRE(report(directory, {"one"}, "whole").exit_code == 0);
  CHECK(answered(directory, "merged") == answered(directory, "whole"));
}

TEST_CASE("studies that do not belong together are not reported together", "[end_to_end][report]") {
  const TempDirectory directory;
  const std::string study = testing::shipped("paper/discrimination.yaml").string();
  const std::string other = directory / "other.yaml";
  testing::write(other,
                 testing::replaced(testing::contents(study), "mass_kg: 0.058", "mass_kg: 0.057"));
  run(study, "P01", directory / "left", first);
  run(study, "P01", directory / "again", first);
  run(other, "P02", directory / "other", second);
  const auto twice = report(directory, {"left", "again"}, "merged");
  CHECK(twice.exit_code == 2);
  CHECK_THAT(twice.standard_error, Contains("participant P01 is in"));
  const auto mixed = report(directory, {"left", "other"}, "merged");
  CHECK(mixed.exit_code == 2);
  CHECK_THAT(mixed.standard_error, Contains("hold different protocols"));
  const auto nowhere = testing::tapstudy({"report", directory / "left", directory / "again"});
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.standard_error, Contains("--out: a report of several directories"));
  CHECK_FALSE(std::filesystem::exists(directory / "merged"));
}

namespace {
const char* const few_answers =
    "participant,stimulus,response\n1,a,a\n1,b,b\n2,a,b\n2,b,b\n3,a,a\n3,b,a\n";
const char* const others =
    "participant,stimulus,response\n1,a,a\n1,b,b\n2,a,a\n2,b,b\n3,a,b\n3,b,b\n";

nlohmann::json block_in(const std::string& directory) {
  return nlohmann::json::parse(testing::contents(directory + "/report.json"))["blocks"][0];
}
}  // namespace

TEST_CASE("two studies are compared by what their own reports say", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "first.csv", few_answers);
  testing::write(directory / "second.csv", others);
  for (const std::string name : {"first", "second"}) {
    REQUIRE(testing::tapstudy(
                {"report", "--counts", directory / (name + ".csv"), "--out", directory / name})
                .exit_code == 0);
  }
  REQUIRE(testing::tapstudy({"report", "--compare", directory / "first.csv",
                             directory / "second.csv", "--out", directory / "both"})
              .exit_code == 0);
  const nlohmann::json rows = block_in(directory / "both")["side_by_side"];
  REQUIRE(rows.size() == 3);
  CHECK(rows[0]["estimate"].get<double>() == 4.0 / 6.0);
  CHECK(rows[1]["estimate"].get<double>() == Approx(5.0 / 6.0));
  for (const std::size_t i : {0U, 1U}) {
    const auto own = block_in(directory / (i == 0 ? "first" : "second"))["accuracy"];
    CHECK(rows[i]["estimate_low"] == own["over_participants_95"][0]);
    CHECK(rows[i]["estimate_high"] == own["over_participants_95"][1]);
  }
  CHECK(rows[2]["estimate"].get<double>() ==
        Approx(rows[1]["estimate"].get<double>() - rows[0]["estimate"].get<double>()));
  CHECK(rows[2]["estimate_low"] < rows[2]["estimate"]);
  CHECK_THAT(testing::contents((directory / "both") + "/report.html"),
             Contains("3 participants have an id in both studies (1, 2, 3)"));
}

TEST_CASE("shares of right answers at other levels of chance are not compared without a word",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "two.csv", few_answers);
  testing::write(directory / "three.csv",
                 "participant,stimulus,response\n5,a,a\n5,b,b\n5,c,c\n6,a,a\n6,b,b\n6,c,a\n"
                 "7,a,a\n7,b,c\n7,c,c\n");
  const auto said =
      testing::tapstudy({"report", "--compare", directory / "two.csv", directory / "three.csv"});
  REQUIRE(said.exit_code == 0);
  CHECK_THAT(said.standard_output, Contains("Guessing gives 0.5 in ") && Contains("0.333 in "));
}

TEST_CASE("a printed matrix is compared with a study of one block, whatever it is called",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "counts.csv", "stimulus,a,b\na,3,1\nb,0,4\n");
  testing::write(directory / "answers.csv", few_answers);
  const auto said = testing::tapstudy(
      {"report", "--compare", directory / "counts.csv", directory / "answers.csv"});
  INFO(said.standard_error);
  REQUIRE(said.exit_code == 0);
  CHECK_THAT(said.standard_output, Contains("accuracy") && Contains("0.875 (0.529 to 0.978)"));
}

TEST_CASE("studies with nothing in common are refused with the reasons", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "counts.csv", "stimulus,a,b\na,3,1\nb,0,4\n");
  const std::string study = directory / "choice";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/reality_vibration.yaml").string(),
                             "--participants", "2", "--no-traces", "--out", study})
              .exit_code == 0);
  const auto refused = testing::tapstudy({"report", "--compare", directory / "counts.csv", study});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error, Contains("nothing to compare") &&
                                         Contains("its task is identification in") &&
                                         Contains("choice in"));
  CHECK(testing::tapstudy({"report", "--compare", directory / "counts.csv"}).exit_code == 2);
}

TEST_CASE("thresholds are compared by their ratio, and not where they are of other proportions",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string example = testing::contents(testing::shipped("examples/damping_jnd.yaml"));
  const auto block = example.find("    procedures:");
  REQUIRE(block != std::string::npos);
  testing::write(directory / "logistic.yaml",
                 example.substr(0, block) + "    function: log_logistic\n" + example.substr(block));
  testing::write(directory / "weibull.yaml",
                 example.substr(0, block) + "    function: weibull\n" + example.substr(block));
  int seed = 0;
  for (const std::string name : {"logistic", "weibull"}) {
    for (const std::string time : {"1", "2"}) {
      REQUIRE(testing::tapstudy({"simulate", directory / (name + ".yaml"), "--participants", "3",
                                 "--seed", std::to_string(++seed), "--no-traces", "--out",
                                 directory / (name + time)})
                  .exit_code == 0);
    }
  }
  REQUIRE(testing::tapstudy({"report", "--compare", directory / "weibull1", directory / "weibull2",
                             "--out", directory / "both"})
              .exit_code == 0);
  const auto rows = block_in(directory / "both")["side_by_side"];
  REQUIRE(rows.size() == 3);
  CHECK(rows[2]["study"] == "ratio");
  CHECK(rows[2]["estimate"].get<double>() ==
        Approx(rows[1]["estimate"].get<double>() / rows[0]["estimate"].get<double>()));
  const auto refused =
      testing::tapstudy({"report", "--compare", directory / "logistic1", directory / "weibull1"});
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.standard_error,
             Contains("log_logistic function") && Contains("weibull function"));
}

namespace {
nlohmann::json block_of(const std::string& report) {
  nlohmann::json block = nlohmann::json::parse(testing::contents(report))["blocks"][0];
  auto& people = block["participants"];
  std::sort(people.begin(), people.end(), [](const auto& one, const auto& other) {
    return one["participant_id"] < other["participant_id"];
  });
  return block;
}
}  // namespace

TEST_CASE("exported answers are counted as the study's own report counts them, and stay simulated",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml"),
                             "--participants", "3", "--seed", "5", "--out", directory / "study"})
              .exit_code == 0);
  REQUIRE(
      testing::tapstudy({"export", directory / "study", "--out", directory / "csv"}).exit_code ==
      0);
  const auto table = testing::tapstudy(
      {"report", "--counts", directory / "csv/trials.csv", "--out", directory / "of_table"});
  REQUIRE(table.exit_code == 0);
  CHECK_THAT(table.standard_output, Contains("SIMULATED"));
  REQUIRE(testing::tapstudy({"report", directory / "study", "--replace"}).exit_code == 0);
  const nlohmann::json own = block_of(directory / "study/report/report.json");
  const nlohmann::json read = block_of(directory / "of_table/report.json");
  for (const char* const key : {"successes", "trials", "value", "wilson_95"}) {
    CHECK(read["accuracy"][key] == own["accuracy"][key]);
  }
  for (const std::size_t end : {0U, 1U}) {  // sums in another order
    CHECK(read["accuracy"]["over_participants_95"][end].get<double>() ==
          Approx(own["accuracy"]["over_participants_95"][end].get<double>()).epsilon(1e-9));
  }
  CHECK(read["participants"] == own["participants"]);
  CHECK(read["response_times"][0] == own["response_times"][0]);
}

TEST_CASE("a BIDS export is not counted, for its rows do not say who was simulated",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml"),
                             "--participants", "1", "--no-traces", "--out", directory / "study"})
              .exit_code == 0);
  REQUIRE(testing::tapstudy(
              {"export", directory / "study", "--format", "bids", "--out", directory / "bids"})
              .exit_code == 0);
  const auto run = testing::tapstudy(
      {"report", "--counts", directory / "bids/sub-sim01/beh/sub-sim01_task-discrimination_beh.tsv",
       "--stimulus-column", "trial_type", "--response-column", "response"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("report the study's directory, or trials.csv"));
  CHECK(std::ranges::count(run.standard_error, '\n') == 1);
}

TEST_CASE("a file that is named twice is refused, not counted twice", "[end_to_end]") {
  const testing::TempDirectory directory;
  testing::write(directory / "answers.csv", "participant,stimulus,response\nP01,a,a\nP01,b,a\n");
  const auto run = testing::tapstudy(
      {"report", "--counts", directory / "answers.csv", directory / "answers.csv"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.standard_error, Contains("holds the same rows as"));
}

TEST_CASE("an export says which of interleaved staircases chose each level", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "s";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("examples/damping_jnd.yaml").string(),
                             "--participants", "1", "--seed", "2", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"export", study, "--out", directory / "e"}).exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  // one line for each answer in either, of the same trials and tracks
  const auto both = testing::run_program(
      {"/usr/bin/python3", "-c",
       "import csv, sys\n"
       "exported = [(r['number'], r['track']) for r in csv.DictReader(open(sys.argv[1]))]\n"
       "reported = [(r['trial'], r['track']) for r in csv.DictReader(\n"
       "  line for line in open(sys.argv[2]) if not line.startswith('#'))]\n"
       "print(sorted(exported) == sorted(reported), len(set(t for _, t in exported)))\n"
       // a staircase turns where the level that follows lies on the other side than the one before
       "tracks = {}\n"
       "for r in csv.DictReader(open(sys.argv[1])):\n"
       "  tracks.setdefault(r['track'], []).append((float(r['level']), r['is_reversal'] == '1', "
       "r['is_correct']))\n"
       "turned, told = [], []\n"
       "for track in tracks.values():\n"
       "  last = 0\n"
       "  for (a, is_reversal, _), (b, _, _) in zip(track, track[1:]):\n"
       "    move = (b > a) - (b < a)\n"
       "    turned.append(bool(move and last and move != last))\n"
       "    told.append(is_reversal)\n"
       "    last = move or last\n"
       "print(turned == told, sum(told) > 3, sorted(set(p[2] for t in tracks.values() for p in "
       "t)))\n",
       (directory / "e") + "/tracks.csv", study + "/report/damping_tracks.csv"});
  INFO(both.standard_error);
  CHECK(both.standard_output == "True 2\nTrue True ['0', '1']\n");
}

namespace {
// JSON is YAML.
testing::ProgramResult validated(const std::string& report) {
  return testing::run_program({"/usr/bin/python3", testing::source("tests/protocols/validate.py"),
                               testing::source("analysis/report/report.schema.json"), report});
}
std::string reported(const testing::TempDirectory& directory, const std::string& protocol) {
  const std::string study = directory / "study";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped(protocol), "--participants", "2",
                             "--no-traces", "--out", study})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  return study + "/report/report.json";
}
}  // namespace

TEST_CASE("reports fit the schema that is shipped", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string protocol =
      GENERATE(as<std::string>{}, "paper/discrimination.yaml", "paper/reality_vibration.yaml",
               "examples/stiffness_jnd.yaml", "examples/triangle_mdf_acrylic.yaml",
               "examples/techniques_compared.yaml", "examples/hardness_magnitude.yaml",
               "examples/cantilever_techniques.yaml");
  const auto result = validated(reported(directory, protocol));
  INFO(protocol << ": " << result.standard_error);
  CHECK(result.exit_code == 0);
}

TEST_CASE("a report that is none does not fit the schema", "[end_to_end]") {
  const testing::TempDirectory directory;
  const nlohmann::json report = nlohmann::json::parse(
      testing::contents(reported(directory, "examples/hardness_magnitude.yaml")));
  const auto fits = [&](const nlohmann::json& changed) {
    testing::write(directory / "changed.json", changed.dump());
    return validated(directory / "changed.json").exit_code == 0;
  };
  CHECK(fits(report));
  for (const char* const path :
       {"/title", "/blocks/0/task", "/blocks/0/means", "/blocks/0/hypotheses", "/loop/ticks"}) {
    nlohmann::json changed = report;
    changed[nlohmann::json::json_pointer{path}] = nlohmann::json::object({{"x", 1.5}});
    INFO(path);
    CHECK_FALSE(fits(changed));
  }
}
