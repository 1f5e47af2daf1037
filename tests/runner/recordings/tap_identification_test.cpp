#include "runner/recordings/tap_identification.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_taps.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
// A sensor that works, another that shows 0.37 all the time.
std::string two_sensors() {
  const analysis::Recording recording = testing::planted_recording(
      {{{62.0, 0.03}}, {{118.0, 0.02}}}, {0.4, 1.7, 3.0}, 3000.0, 4.3, 0.01, 5);
  std::string text = "live,dead\n";
  for (const double sample : recording.samples) {
    text += fmt::format("{:.7g},0.37\n", sample);
  }
  return text;
}

runner::TapIdentification identified(const std::string& file, std::vector<std::string> columns) {
  runner::TapQuestion question;
  question.recordings = {file};
  question.reading.rate_hz = 3000.0;
  question.band = analysis::Band{20.0, 400.0};
  question.columns = std::move(columns);
  runner::Progress progress{"identifying"};
  return runner::identify_taps(question, progress);
}
}  // namespace

TEST_CASE("a sensor that shows nothing is left out with a remark, and the others count",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, two_sensors());
  const runner::TapIdentification found = identified(file, {"dead", "live"});
  CHECK(found.agreed.size() == 2);
  CHECK(found.taps.size() == 3);
  REQUIRE(found.remarks.size() == 3);
  CHECK_THAT(found.remarks.front(), Contains("dead") && Contains("does not change"));
}

TEST_CASE("one channel named in two ways is refused", "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, two_sensors());
  CHECK_THROWS_WITH(identified(file, {"live", "1"}), Contains("'live' is named twice"));
}
