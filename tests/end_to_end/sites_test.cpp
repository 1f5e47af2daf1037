#include "support/catch.hpp"
#include "support/processes.hpp"
using namespace tapstudy;

// A server is started for each, and people's sessions are simulated.
namespace {
void run_sites(const std::string& test) {
  const auto result = testing::run_script("sites/sites_test.py", {test});
  INFO(result.standard_error);
  CHECK(result.exit_code == 0);
}
}  // namespace

TEST_CASE(
    "a push that is cut off, or whose server is killed, shows nothing, loses nothing and ends",
    "[end_to_end][postgresql]") {
  run_sites("cut");
}

TEST_CASE("a server's report of two sites that push at once is that of their directories",
          "[end_to_end][postgresql]") {
  run_sites("report");
}

TEST_CASE("no two participants of any site are given the same row", "[end_to_end][postgresql]") {
  run_sites("rows");
}

TEST_CASE("a server's roles, certificate and earlier rows refuse what is not theirs",
          "[end_to_end][postgresql]") {
  run_sites("refused");
}

TEST_CASE("two sites' participants of one name, and a site under two names, are refused by a push",
          "[end_to_end][postgresql]") {
  run_sites("namesakes");
}
