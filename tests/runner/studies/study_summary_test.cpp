#include "runner/studies/study_summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "analysis/report/confusion/chance_tests.hpp"
#include "protocols/reader/read_protocol.hpp"
#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
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

namespace {
std::string balanced_study(const std::string& stimuli, int repetitions) {
  std::string text = testing::contents(testing::shipped("paper/discrimination.yaml"));
  text = testing::replaced(text, "[acrylic_two, mdf_two, acrylic_three, mdf_three]", stimuli);
  text = testing::replaced(text, "repetitions: 2", fmt::format("repetitions: {}", repetitions));
  return testing::replaced(text, "order: shuffle", "order: williams");
}

double smallest_p_of(const std::string& text, int participants) {
  const auto design =
      runner::design_of(protocols::parse_protocol(text, "study.yaml"), results::Mode::simulated);
  std::vector<analysis::Place> places;
  for (int i = 0; i < participants; ++i) {
    places.push_back({i, i});
  }
  return analysis::smallest_chance_p(design.blocks.at(0), places).value();
}
}  // namespace

// Of n sequences that are dealt to k, n! / (n - k)! ways are equally likely; runs of n are dealt by
// themselves, and all groups of a study alike.
TEST_CASE("right answers alone have p of one in as many as the ways to deal balanced orders",
          "[runner][report]") {
  const std::string two = balanced_study("[acrylic_two, mdf_three]", 4);
  const std::string four = balanced_study("[acrylic_two, mdf_two, acrylic_three, mdf_three]", 4);
  struct Case {
    std::string text;
    int participants{};
    double ways{};
  };
  for (const Case& of :
       {Case{two, 1, 2.0}, Case{two, 2, 2.0}, Case{two, 5, 8.0}, Case{two, 8, 16.0},
        Case{four, 2, 12.0}, Case{four, 4, 24.0},
        Case{four + "groups: [{name: a}, {name: b}]\n", 8, 24.0},
        // three groups of rows, where four presentations do not balance steps
        Case{testing::replaced(four, "repetitions: 4", "repetitions: 2"), 4, 72.0}}) {
    constexpr double draws = 9999.0;
    const double p = 1.0 / of.ways;
    CAPTURE(of.participants, of.ways);
    CHECK(smallest_p_of(of.text, of.participants) ==
          Approx(p).margin(1.0 / draws + 4.0 * std::sqrt(p * (1.0 - p) / draws)));
  }
  CHECK(smallest_p_of(testing::replaced(two, "order: williams", "order: shuffle"), 8) == 1e-3);
}

TEST_CASE("check promises no power, and a report says so, where no answers reach p < .05",
          "[runner][report][slow]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "study.yaml";
  testing::write(file, testing::replaced(balanced_study("[acrylic_two, mdf_three]", 4),
                                         "noise_db: 14", "noise_db: 1"));
  const auto few = testing::tapstudy({"check", file, "--participants", "8"});
  CHECK_THAT(few.standard_output,
             Contains("even if all answers are right, the report's test against chance gives about "
                      "p = .06") &&
                 !Contains("power of that test"));
  CHECK_THAT(testing::tapstudy({"check", file, "--participants", "16"}).standard_output,
             !Contains("even if all answers are right") && Contains("power of that test"));
  REQUIRE(testing::tapstudy({"simulate", file, "--participants", "8", "--no-traces", "--out",
                             directory / "study"})
              .exit_code == 0);
  const std::string report =
      testing::tapstudy({"report", directory / "study", "--only", "discrimination"})
          .standard_output;
  CHECK_THAT(std::regex_replace(report, std::regex{"\\s+"}, " "),
             Contains("64/64 against 50 % by chance: p = .06") &&
                 Contains("one-sided; the smallest p that this design allows"));
}
