// Mixed models of a study's answers, fitted by R.
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "runner/studies/mixed_models/fit_in_r.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::TempDirectory;

namespace {
std::string printed(const std::string& shell) {
  const auto run = testing::run_program({"/bin/sh", "-c", shell});
  INFO(shell << '\n' << run.standard_error);
  REQUIRE(run.exit_code == 0);
  return run.standard_output;
}

nlohmann::json models_in(const std::string& report) {
  return nlohmann::json::parse(testing::contents(report + "/report.json"))
      .at("study")
      .at("mixed_models");
}

// Six simulated participants of a factorial design, structure by material.
std::string factorial_study(const TempDirectory& directory) {
  std::string study = directory / "study";
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml"),
                             "--participants", "6", "--seed", "3", "--no-traces", "--out", study})
              .exit_code == 0);
  return study;
}
}  // namespace

// The other programs: lme4 and ordinal called directly, on single answers.
TEST_CASE("mixed models are those that R's packages fit, of public and of simulated data",
          "[runner][mixed_models][slow]") {
  const TempDirectory directory;
  const std::string script = directory / "mixed_models.R";
  testing::write(script, runner::mixed_models_script());
  const auto compared = testing::run_program(
      {"/usr/bin/Rscript", "--vanilla",
       testing::source("tests/runner/studies/mixed_models/compare_with_packages.R"), script,
       directory.path()});
  INFO(compared.standard_error);
  CHECK(compared.exit_code == 0);
  CHECK_THAT(compared.standard_output, Contains("answered factor_a=a1:factor_b=b1:group=experts") &&
                                           Contains("thresholds factor_a=a1:factor_b=b1"));
}

// Six people, two factors, 12 answers to each of four stimuli: `right` of those to a1 with b1.
TEST_CASE("an effect that no answer determines has no p, and the note says which cell",
          "[runner][mixed_models][slow]") {
  const TempDirectory directory;
  testing::write(directory / "mixed_models.R", runner::mixed_models_script());
  for (const int right : {10, 12}) {
    std::string data = "block,kind,participant_id,outcome,count,factor_a,factor_b\n";
    for (int person = 0; person < 6; ++person) {
      for (int cell = 0; cell < 4; ++cell) {
        const int of_cell = cell == 0 ? right : 5 + (person + cell) % 4;
        for (const int outcome : {1, 0}) {
          data += fmt::format("ident,right_or_wrong,P{},{},{},a{},b{}\n", person, outcome,
                              outcome == 1 ? of_cell : 12 - of_cell, 1 + cell / 2, 1 + cell % 2);
        }
      }
    }
    testing::write(directory / "mixed_models_data.csv",
                   std::regex_replace(data, std::regex{"[^\n]*,0,a[^\n]*\n"}, ""));
    printed("Rscript --vanilla '" + directory.path() + "/mixed_models.R' 2>&1");
    std::ifstream file{directory / "mixed_models.csv"};
    const auto rows = analysis::read_mixed_models(file, "mixed_models.csv");
    REQUIRE(rows.size() >= 4);
    for (std::size_t i = 0; i < 4; ++i) {  // intercept, a, b, a × b: each holds the cell
      CAPTURE(right, rows[i].term, rows.front().note);
      CHECK(rows[i].p.has_value() == (right < 12));
      CHECK(rows[i].estimate.has_value() == (right < 12));
    }
    CHECK((rows.front().note.find("all right for factor_a=a1 with factor_b=b1") !=
           std::string::npos) == (right == 12));
  }
}

TEST_CASE("the exported script finds what the report says, of all answers that count",
          "[runner][mixed_models][slow]") {
  const TempDirectory directory;
  const std::string study = factorial_study(directory);
  const std::string exported = directory / "csv";
  REQUIRE(testing::tapstudy({"export", study, "--out", exported}).exit_code == 0);
  const std::string counted =
      "FROM v_trials WHERE status = 'answered' AND NOT is_practice AND NOT is_catch";
  CHECK(printed("/usr/bin/python3 -c \"import pandas; d = pandas.read_csv('" + exported +
                "/mixed_models_data.csv'); print(d['count'].sum(), "
                "int((d['count'] * d.outcome).sum()), sep='|')\"") ==
        printed("sqlite3 '" + study + "/study.db' \"SELECT count(*), sum(is_correct) " + counted +
                "\""));
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  printed("Rscript --vanilla '" + exported + "/mixed_models.R'");  // beside its data
  std::ifstream file{exported + "/mixed_models.csv"};
  const auto by_script = analysis::read_mixed_models(file, "mixed_models.csv");
  const nlohmann::json reported = models_in(study + "/report");
  REQUIRE(by_script.size() == reported.size());
  bool has_interaction = false;
  for (std::size_t i = 0; i < by_script.size(); ++i) {
    const std::string term = reported[i].at("term");
    CAPTURE(term);
    CHECK(term == by_script[i].term);
    CHECK(reported[i].at("p").is_null() != by_script[i].p.has_value());
    if (by_script[i].estimate) {
      CHECK(reported[i].at("estimate").get<double>() == *by_script[i].estimate);
    }
    has_interaction = has_interaction || (term.starts_with("factor_material=") &&
                                          term.find(":factor_structure=") != std::string::npos);
  }
  CHECK(has_interaction);
  CHECK_THAT(
      testing::contents(study + "/report/report.html"),
      Contains("6 participants, ") && Contains("Mixed models") && Contains(" × factor_structure="));
  const auto verified = testing::tapstudy({"verify", study});
  INFO(verified.standard_output);
  CHECK(verified.exit_code == 0);
  CHECK_THAT(verified.standard_output, Contains("identical to a regenerated report"));

  SECTION("a verification fits them again, and finds what was changed in every file alike") {
    const std::string p = fmt::format("{}", *std::ranges::find_if(by_script, [](const auto& row) {
                                               return row.p.has_value();
                                             })->p);
    printed(fmt::format("cd '{}/report' && sed -i 's/{}/0.0012345/' report.json mixed_models.csv",
                        study, p));
    const auto changed = testing::tapstudy({"verify", study});
    CHECK(changed.exit_code != 0);
    CHECK_THAT(changed.standard_output, Contains("R fits another model now"));
    const auto without = testing::run_program(
        {"/usr/bin/env", "PATH=" + directory.path(), testing::tapstudy_program(), "verify", study});
    CHECK_THAT(without.standard_output, Contains("are taken as they stand there: not fitted"));
  }
  SECTION("without R one line says how to get it, and the rest is reported") {
    const auto without = testing::run_program(
        {"/usr/bin/env", "PATH=" + directory.path(), testing::tapstudy_program(), "report", study,
         "--only", "mixed_models", "--out", directory / "without"});
    INFO(without.standard_error);
    REQUIRE(without.exit_code == 0);
    const nlohmann::json models = models_in(directory / "without");
    REQUIRE(models.size() == 1);
    CHECK_THAT(models[0].at("note").get<std::string>(),
               Contains("apt install r-base-core r-cran-lme4 r-cran-ordinal"));
  }
}
