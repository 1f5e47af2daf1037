// `identify` of frequency responses.
#include <fmt/format.h>

#include <complex>
#include <numbers>
#include <sstream>

#include "analysis/statistics/csv_rows.hpp"
#include "runner/laboratory/identify/modal_report.hpp"
#include "runner/laboratory/identify/responses/response_identification.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_responses.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
const testing::PlantedStructure panel{{{52.0, 0.02}, {96.0, 0.01}, {141.0, 0.015}}, 4};

analysis::FrequencyResponses of_panel(analysis::ResponseKind kind) {
  return testing::planted_responses(panel, kind, {10.0, 180.0}, 341, 50.0);
}
}  // namespace

TEST_CASE("identify makes of frequency responses what it makes of taps, and shapes",
          "[runner][identify][responses]") {
  const testing::TempDirectory directory;
  testing::write(directory / "panel.uff",
                 testing::universal_file(of_panel(analysis::ResponseKind::accelerance)));
  const auto run =
      testing::tapstudy({"identify", directory / "panel.uff", "--out", directory / "found"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK_THAT(run.standard_output, Contains("4 frequency responses, accelerance, 10 to 180 Hz"));
  for (const char* const file : {"identified.json", "stabilisation.svg", "responses.svg"}) {
    CHECK_FALSE(testing::contents(directory / "found/" + file).empty());
  }
  const std::string yaml = testing::contents(directory / "found/identified.yaml");
  CHECK_THAT(yaml, Contains("damping: {alpha_per_s: ") || Contains("# damping: {alpha_per_s: "));
  std::istringstream shapes{testing::contents(directory / "found/shapes.csv")};
  const analysis::CsvText table = analysis::read_csv(shapes, "shapes.csv");
  REQUIRE(table.rows.size() == 1 + 3 * 4);
  const auto number = [&](std::size_t row, std::size_t column) {
    return table.number(table.rows[row].cells[column]).value();
  };
  for (std::size_t mode = 0; mode < 3; ++mode) {
    const std::size_t first = 1 + 4 * mode;
    CHECK(number(first, 1) == Approx(panel.poles[mode].frequency_hz).epsilon(1e-3));
    CHECK(table.rows[first + 2].cells[2] == "3+Z");
    for (std::size_t place = 1; place < 4; ++place) {  // shapes are known up to a factor
      CHECK(number(first + place, 3) * panel.displacement(mode, 0) ==
            Approx(number(first, 3) * panel.displacement(mode, static_cast<int>(place)))
                .margin(0.03));
    }
  }
}

TEST_CASE("sidebands of a mode of responses are named, what moves otherwise is a mode",
          "[runner][identify][responses]") {
  const testing::PlantedStructure modulated{{{16.0, 0.02}, {141.0, 0.01}}, 4};
  const auto shape = GENERATE(std::size_t{0}, std::size_t{1});
  analysis::FrequencyResponses responses = testing::planted_responses(
      modulated, analysis::ResponseKind::accelerance, {10.0, 180.0}, 681, 60.0);
  for (const double beside_hz : {-16.0, 16.0}) {
    const double hz = 141.0 + beside_hz;
    const auto p = analysis::log_of({hz, (141.0 * 0.01 + 16.0 * 0.02) / hz}, 1.0);
    for (Eigen::Index line = 0; line < responses.frequency_hz.size(); ++line) {
      const std::complex<double> s{0.0, 2.0 * std::numbers::pi * responses.frequency_hz[line]};
      for (int place = 0; place < modulated.places; ++place) {
        const auto r = 0.1 * modulated.residue(1, place, 0) * modulated.displacement(shape, place) /
                       modulated.displacement(1, place);
        responses.values(line, place) += s * s * (r / (s - p) + std::conj(r) / (s - std::conj(p)));
      }
    }
  }
  const testing::TempDirectory directory;
  testing::write(directory / "panel.uff", testing::universal_file(responses));
  const auto run = testing::tapstudy(
      {"identify", directory / "panel.uff", "--out", directory / "found", "--json"});
  INFO(run.standard_output << run.standard_error);
  REQUIRE(run.exit_code == 0);
  CHECK((run.standard_output.find("\"standing\": \"combination\"") != std::string::npos) ==
        (shape == 1));
}

TEST_CASE("identify takes recordings or frequency responses, and of these no taps' options",
          "[runner][identify][responses]") {
  const testing::TempDirectory directory;
  testing::write(directory / "panel.uff",
                 testing::universal_file(of_panel(analysis::ResponseKind::mobility)));
  testing::write(directory / "taps.csv", "time_s,acc\n0,1\n");
  const auto refused = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"identify", directory / "panel.uff", "--out", directory / "found"});
    const auto run = testing::tapstudy(more);
    CHECK(run.exit_code == 2);
    return run.standard_error;
  };
  CHECK_THAT(refused({directory / "taps.csv"}), Contains("one kind at a time"));
  CHECK_THAT(refused({"--column", "1"}), Contains("not for frequency responses"));
  CHECK_THAT(refused({"--response", "receptance"}), Contains("says it is of mobility"));
}
