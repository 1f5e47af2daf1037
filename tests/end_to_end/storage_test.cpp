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
