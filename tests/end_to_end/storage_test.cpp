#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using namespace nlohmann::literals;

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
  CHECK_THAT(verified.standard_output, Contains("differs: ") && Contains(words));
}

TEST_CASE("verify makes the report anew and names the numbers that were changed", "[end_to_end]") {
  const testing::TempDirectory directory;
  const std::string study = directory / "s";
  const auto simulate = [&](const char* participants) {
    return testing::tapstudy({"simulate", testing::shipped("paper/discrimination.yaml").string(),
                              "--participants", participants, "--seed", "1", "--out", study});
  };
  REQUIRE(simulate("3").exit_code == 0);
  REQUIRE(testing::tapstudy({"report", study}).exit_code == 0);
  const auto sound = testing::tapstudy({"verify", study});
  CHECK(sound.exit_code == 0);
  CHECK_THAT(sound.standard_output, Contains("identical to a regenerated report"));
  const std::string report = study + "/report.json";
  const auto json = nlohmann::json::parse(testing::contents(report));
  const auto changed = [&](const nlohmann::json::json_pointer& at) {
    nlohmann::json other = json;
    other[at] = other[at].get<int>() + 1;
    testing::write(report, other.dump());
    const auto verified = testing::tapstudy({"verify", study});
    CHECK(verified.exit_code == 5);
    CHECK_THAT(verified.standard_output, Contains("differs: report.json /blocks/"));
    testing::write(report, json.dump());
  };
  changed("/blocks/0/accuracy/successes"_json_pointer);
  changed("/blocks/0/counts/1/2"_json_pointer);
  CHECK(testing::tapstudy({"verify", study}).exit_code == 0);
  const std::string table = study + "/discrimination_confusion.csv";
  testing::write(table, testing::contents(table) + "x,0,0,0,0\n");
  const auto verified = testing::tapstudy({"verify", study});
  CHECK(verified.exit_code == 5);
  CHECK_THAT(verified.standard_output, Contains("discrimination_confusion.csv: is not"));
  std::filesystem::remove(table);
  nlohmann::json older = json;
  older["participants"] = 2;
  testing::write(report, older.dump());
  CHECK_THAT(testing::tapstudy({"verify", study}).standard_output,
             Contains("not compared: it was made of fewer participants"));
}
