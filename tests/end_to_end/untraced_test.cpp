#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
void simulate(const std::string& out, const std::vector<std::string>& options = {}) {
  std::vector<std::string> arguments{
      "simulate",       testing::shipped("paper/discrimination.yaml"),
      "--participants", "2",
      "--seed",         "5",
      "--out",          out};
  arguments.insert(arguments.end(), options.begin(), options.end());
  REQUIRE(testing::tapstudy(arguments).exit_code == 0);
}
std::string query(const std::string& study, const std::string& sql) {
  return testing::run_program({"/usr/bin/sqlite3", study + "/study.db", sql}).standard_output;
}
}  // namespace

TEST_CASE("a study without traces has the answers and events of one with them", "[end_to_end]") {
  const testing::TempDirectory directory;
  simulate(directory / "traced");
  simulate(directory / "untraced", {"--no-traces"});
  const std::string same =
      "SELECT participant_id, trial.number, response, response_time_s, event.t_s, kind, value "
      "FROM trial JOIN session USING (session_id) JOIN response USING (trial_id) "
      "JOIN event USING (trial_id) WHERE kind <> 'untraced' "
      "ORDER BY participant_id, trial.number, event.t_s, kind";
  CHECK(query(directory / "traced", same).size() > 1000);
  CHECK(query(directory / "traced", same) == query(directory / "untraced", same));
  CHECK(query(directory / "untraced", "SELECT count(*) FROM trace_chunk") == "0\n");
  const auto verified = testing::tapstudy({"verify", directory / "untraced"});
  CHECK(verified.exit_code == 0);
  CHECK(testing::tapstudy({"report", directory / "untraced"}).exit_code == 0);
}

TEST_CASE("a trace that was removed is noticed", "[end_to_end]") {
  const testing::TempDirectory directory;
  simulate(directory / "study");
  query(directory / "study", "DELETE FROM trace_chunk WHERE trial_id = 3");
  const auto verified = testing::tapstudy({"verify", directory / "study"});
  CHECK(verified.exit_code != 0);
  CHECK_THAT(verified.standard_output + verified.standard_error,
             Contains("trial 3 ") && Contains("its trace is missing"));
}
