#include "runner/studies/study_summary.hpp"

#include "protocols/reader/read_protocol.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
std::vector<std::string> said_of(const std::string& technique,
                                 const std::vector<std::string>& versions) {
  const protocols::Protocol protocol = protocols::parse_protocol(
      testing::replaced(testing::contents(testing::shipped("paper/discrimination.yaml")),
                        "technique: fem", "technique: " + technique),
      "study.yaml");
  std::vector<results::SessionRow> sessions;
  for (const std::string& version : versions) {
    sessions.emplace_back().program_version = version;
  }
  return runner::rendered_by_earlier_versions(protocol, sessions);
}
}  // namespace

TEST_CASE("a report says what earlier versions rendered otherwise, of the studies it concerns",
          "[runner][report]") {
  // 3000 N/m beside 3000 and 300 N/m in series
  const auto said = said_of("fem-coupled", {"0.2.0", "0.1.0", "0.1.0", "0.1.7"});
  REQUIRE(said.size() == 1);
  CHECK_THAT(said.front(), Contains("sessions run by tapstudy 0.1.0, 0.1.7: fem-coupled") &&
                               Contains("3273 N/m instead of 3000") &&
                               Contains("the plate carried 8 % of the force"));
  CHECK(said_of("fem-coupled", {"0.2.0", "0.10.0", "1.0.0", "of the future"}).empty());
  CHECK(said_of("fem", {"0.1.0"}).empty());
}

TEST_CASE("a report says that earlier versions held springs otherwise, of plates on springs",
          "[runner][report]") {
  const auto said_of_feet = [](const std::string& version) {
    std::vector<results::SessionRow> sessions(1);
    sessions.front().program_version = version;
    return runner::rendered_by_earlier_versions(
        protocols::read_protocol(testing::shipped("examples/plate_on_feet.yaml")), sessions);
  };
  REQUIRE(said_of_feet("0.3.0").size() == 1);
  CHECK_THAT(said_of_feet("0.3.0").front(), Contains("sessions run by tapstudy 0.3.0: springs"));
  CHECK(said_of_feet("0.4.0").empty());
}

TEST_CASE("a report says that sheets with an automatic mesh had other elements before",
          "[runner][report]") {
  const auto said_of_strip = [](const std::string& size, const std::string& mesh,
                                const std::string& version) {
    std::vector<results::SessionRow> sessions(1);
    sessions.front().program_version = version;
    const std::string text =
        testing::contents(testing::shipped("examples/cantilever_techniques.yaml"));
    return runner::rendered_by_earlier_versions(
        protocols::parse_protocol(
            testing::replaced(testing::replaced(text, "[0.3, 0.04, 0.01]", size),
                              "{order: 2, max_tet_volume_m3: 5.0e-7}", mesh),
            "strip.yaml"),
        sessions);
  };
  const std::string thin = "[0.3, 0.09, 0.002]";
  REQUIRE(said_of_strip(thin, "auto", "0.4.0").size() == 1);
  CHECK_THAT(said_of_strip(thin, "auto", "0.4.0").front(),
             Contains("tapstudy 0.4.0: mesh: auto took tetrahedra for finite_elements, and takes"));
  CHECK(said_of_strip(thin, "auto", "0.5.0").empty());
  CHECK(said_of_strip(thin, "{order: 3, flattening: 20}", "0.4.0").empty());
  CHECK(said_of_strip("[0.3, 0.09, 0.02]", "auto", "0.4.0").empty());
}
