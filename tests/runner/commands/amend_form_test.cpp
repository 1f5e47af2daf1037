// An answer to a questionnaire that is corrected after the session.
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using testing::replaced;
using testing::TempDirectory;

namespace {
// P01 is 31, holds b, and took part in a pilot session.
std::string study_with_form(const TempDirectory& directory) {
  const std::string file = directory / "study.yaml";
  testing::write(
      file,
      replaced(replaced(testing::contents(testing::shipped("paper/discrimination.yaml")),
                        "repetitions: 2", "repetitions: 1"),
               "\nblocks:",
               "\nforms:\n  about:\n    title: About you\n    items:\n"
               "      - {name: age, kind: number, question: 'Age?', min: 18, max: 99, bids: age}\n"
               "      - {name: held, kind: single_choice, question: 'Held?', options: [a, b]}\n"
               "      - {name: which, kind: text, question: 'Which?', asked_if: {item: held, is: "
               "[a]}}\n"
               "      - {name: remarks, kind: text, question: 'Else?', required: false}\n"
               "forms_before: [about]\nblocks:"));
  const std::string study = directory / "study";
  const auto run =
      testing::tapstudy({"run", file, "--participant", "P01", "--out", study, "--seed", "5"},
                        "31\n2\nnothing of note\n1\n2\n3\n4\n");
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  return study;
}

testing::ProgramResult amended(const std::string& study, const std::string& action) {
  return testing::tapstudy({"amend", study, action, "--participant", "P01"});
}

std::string sql(const std::string& study, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", query}).standard_output;
}
}  // namespace

TEST_CASE("a corrected answer to a questionnaire is what counts, and its trail stays",
          "[runner][form_amendments]") {
  const TempDirectory directory;
  const std::string study = study_with_form(directory);
  CHECK_THAT(amended(study, "correct about.age 32").standard_output,
             Contains("'age' of form 'about' (session begin): 31, corrected to 32"));
  CHECK(amended(study, "correct about.age@session begin 33").exit_code == 0);
  CHECK(amended(study, "correct about.remarks the plate was warm").exit_code == 0);
  CHECK(sql(study, "SELECT answer FROM form_answer WHERE item = 'age'") == "31\n");
  CHECK(sql(study,
            "SELECT detail ->> '$.before', detail ->> '$.after' FROM operator_action "
            "WHERE action = 'amend' AND detail ->> '$.item' = 'age' AND t_s >= 0") ==
        "31|32\n32|33\n");
  const auto verified = testing::tapstudy({"verify", study});
  INFO(verified.standard_output);
  CHECK(verified.exit_code == 0);

  REQUIRE(testing::tapstudy({"export", study, "--out", directory / "csv"}).exit_code == 0);
  CHECK_THAT(testing::contents(directory / "csv/questionnaires.csv"),
             Contains(",answer,amended,amended_from\n") && Contains(",age,33,1,31\n") &&
                 Contains(",held,b,0,NA\n"));
  REQUIRE(testing::tapstudy({"export", study, "--format", "bids", "--out", directory / "bids"})
              .exit_code == 0);
  CHECK_THAT(testing::contents(directory / "bids/participants.tsv"), Contains("\t33"));
  REQUIRE(testing::tapstudy({"report", study, "--only", "questionnaires"}).exit_code == 0);
  const std::string report = testing::contents(study + "/report/report.json");
  CHECK_THAT(report, Contains("P01: answer to 'age' of form 'about' corrected from 31 to 32") &&
                         Contains("corrected from 32 to 33") &&
                         Contains("P01: answer to 'remarks' of form 'about' corrected\""));
  CHECK_THAT(report, !Contains("warm"));

  SECTION("a redacted copy has it without free text, and verifies") {
    const std::string copy = directory / "copy";
    REQUIRE(testing::tapstudy({"redact", study, "--out", copy}).exit_code == 0);
    CHECK(sql(copy,
              "SELECT detail ->> '$.item', detail ->> '$.after' FROM operator_action "
              "WHERE action = 'amend'") == "age|32\nage|33\nremarks|(removed)\n");
    CHECK_THAT(testing::contents(copy + "/study.db"), !Contains("warm"));
    CHECK(testing::tapstudy({"verify", copy}).exit_code == 0);
  }
  SECTION("a trail that contradicts the answers is found") {
    sql(study,
        "UPDATE operator_action SET detail = json_set(detail, '$.before', '77') "
        "WHERE detail ->> '$.after' = '33'");
    const auto wrong = testing::tapstudy({"verify", study});
    CHECK(wrong.exit_code != 0);
    CHECK_THAT(
        wrong.standard_output + wrong.standard_error,
        Contains("correction of 'about.age'") && Contains("the answer before it was another one"));
  }
}

TEST_CASE("an answer is not corrected to what cannot be, nor where something followed from it",
          "[runner][form_amendments]") {
  const TempDirectory directory;
  const std::string study = study_with_form(directory);
  const auto refused = [&](const std::string& action, const std::string& said) {
    const auto result = amended(study, action);
    INFO(action);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.standard_error, Contains(said));
  };
  refused("correct about.age 12", "'age' of form 'about': ");
  refused("correct about.age 31", "is 31 already");
  refused("correct about.age", "which answer?");
  refused("correct about.held a", "decided whether 'which' of form 'about' is asked");
  refused("correct about.which stylus", "was not asked 'which'");
  refused("correct about.age@nowhere 32", "one of: session begin, session end, discrimination");
  refused("correct about.size 32", "no form has such an item");
  CHECK(sql(study, "SELECT count(*) FROM operator_action WHERE action = 'amend'") == "0\n");
}
