#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>

#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

TEST_CASE("a simulated study takes the disk that check says it will", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string protocol = testing::shipped("paper/discrimination.yaml");
  const auto check = testing::tapstudy({"check", protocol, "--participants", "6"});
  std::smatch said;
  REQUIRE(std::regex_search(check.standard_output, said, std::regex{"about ([0-9.]+) MB of disk"}));
  REQUIRE(testing::tapstudy({"simulate", protocol, "--participants", "6", "--seed", "1", "--out",
                             directory / "s"})
              .exit_code == 0);
  const auto bytes = static_cast<double>(std::filesystem::file_size(directory / "s/study.db"));
  CHECK(1e-6 * bytes == Approx(std::stod(said[1])).epsilon(0.2));
}

TEST_CASE("verify notices what was changed of a study, its sessions or its statistics",
          "[end_to_end]") {
  const testing::TempDirectory directory;
  REQUIRE(testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml").string(),
                             "--participants", "2", "--seed", "1", "--out", directory / "s"})
              .exit_code == 0);
  REQUIRE(testing::tapstudy({"verify", directory / "s"}).exit_code == 0);
  const auto [change, words] = GENERATE(table<std::string, std::string>(
      {{"participant SET mode = 'real'", "mode"},
       {"study SET protocol_text = replace(protocol_text, '3.2e9', '3.3e9')", "protocol_sha256"},
       {"session SET seed = seed + 1 WHERE session_id = 1", "seed"},
       {"session SET planned_order = planned_order || x'0a' WHERE session_id = 2", "planned_order"},
       {"tick_statistics SET saturated = saturated + 1 WHERE trial_id = 3", "saturated"}}));
  const auto changed = testing::run_program(
      {"/usr/bin/sqlite3", (directory / "s") + "/study.db", "UPDATE " + change});
  INFO(changed.standard_error);
  REQUIRE(changed.exit_code == 0);
  const auto verified = testing::tapstudy({"verify", directory / "s"});
  CHECK(verified.exit_code == 5);
  CHECK_THAT(verified.standard_output, Catch::Contains("differs: ") && Catch::Contains(words));
}
