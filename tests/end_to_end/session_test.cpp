// A person's session at the terminal, in real time with a simulated hand.
#include <catch2/catch.hpp>

#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using Catch::Matchers::Contains;
using testing::TempDirectory;

namespace {
std::string paper(const std::string& name) {
  return testing::shipped("paper/" + name).string();
}
testing::ProgramResult session(const TempDirectory& directory, const std::string& protocol,
                               const std::string& input,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> line{"run",   paper(protocol),         "--participant", "P01",
                                "--out", directory / "the_study", "--seed",        "5"};
  line.insert(line.end(), more.begin(), more.end());
  return testing::tapstudy(line, input);
}
std::string sql(const TempDirectory& directory, const std::string& query) {
  return testing::run_program({"/usr/bin/sqlite3", (directory / "the_study") + "/study.db", query})
      .standard_output;
}
}  // namespace

TEST_CASE("a session asks every question and stores every answer", "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "discrimination.yaml", "1\n2\n9\nx\n3\n4\n1\n2\n3\n4\n");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, Contains("Trial 8 of 8"));
  CHECK_THAT(result.standard_error, Contains("please type a number from 1 to 4"));
  CHECK_THAT(result.standard_output, Contains("all 8 trials are stored"));
  CHECK(
      sql(directory, "SELECT group_concat(response) FROM response") ==
      "acrylic_two,mdf_two,acrylic_three,mdf_three,acrylic_two,mdf_two,acrylic_three,mdf_three\n");
  CHECK_THAT(sql(directory,
                 "SELECT mode, seed, device, scheduler FROM session "
                 "JOIN participant USING (participant_id)"),
             Catch::Matchers::StartsWith("real|5|simulated_hand|SCHED_"));
  CHECK(sql(directory,
            "SELECT doctor ->> '$.idle.count', length(doctor ->> '$.verdict') > 20 "
            "FROM session") == "500|1\n");
  CHECK(sql(directory, "SELECT sum(dropped_samples) FROM tick_statistics") == "0\n");
  CHECK(sql(directory, "PRAGMA integrity_check") == "ok\n");
}

TEST_CASE("a stopped session keeps its answers and is resumed at the next trial",
          "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto stopped = session(directory, "discrimination.yaml", "1\n2\n3\n");
  CHECK(stopped.exit_code == 130);
  CHECK_THAT(stopped.standard_error, Contains("every answer given so far is kept"));
  CHECK(sql(directory, "SELECT group_concat(number || status) FROM trial") ==
        "1answered,2answered,3answered,4interrupted\n");
  CHECK(session(directory, "discrimination.yaml", "1\n").exit_code == 2);  // not without --resume
  const auto resumed = session(directory, "discrimination.yaml", "4\n4\n4\n4\n4\n", {"--resume"});
  INFO(resumed.standard_error);
  CHECK(resumed.exit_code == 0);
  CHECK(sql(directory,
            "SELECT count(DISTINCT number), count(*) FROM trial "
            "WHERE status = 'answered'") == "8|8\n");
  CHECK(sql(directory, "SELECT count(DISTINCT planned_order) FROM session") == "1\n");
}

TEST_CASE("in a choice one switches freely and every visit is stored", "[end_to_end][threads]") {
  const TempDirectory directory;
  const auto result = session(directory, "reality_finger.yaml", "a\nb\nz\nB\n= c\n");
  INFO(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.standard_error, !Contains("finite_elements"));  // blind
  CHECK(sql(directory, "SELECT group_concat(label) FROM alternative") == "A,B,C\n");
  CHECK(sql(directory,
            "SELECT response = (SELECT stimulus FROM alternative WHERE label = 'C') "
            "FROM response") == "1\n");
}

TEST_CASE("a pilot stays out of the report of real participants", "[end_to_end][threads]") {
  const TempDirectory directory;
  REQUIRE(session(directory, "reality_finger.yaml", "= a\n", {"--pilot"}).exit_code == 0);
  REQUIRE(testing::tapstudy({"run", paper("reality_finger.yaml"), "--participant", "P02", "--out",
                             directory / "the_study"},
                            "= b\n")
              .exit_code == 0);
  const auto report = testing::tapstudy({"report", directory / "the_study"});
  CHECK(report.exit_code == 0);
  CHECK_THAT(report.standard_output, Contains("1/1"));
  CHECK_THAT(report.standard_output, !Contains("/2"));
}
