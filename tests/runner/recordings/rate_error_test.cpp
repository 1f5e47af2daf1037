#include "runner/recordings/rate_error.hpp"

#include <fmt/format.h>

#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/synthetic_taps.hpp"
#include "support/texts.hpp"
using namespace tapstudy;

namespace {
constexpr double stated_hz = 3000.0;
constexpr double wrong_by = 0.0009;
const std::vector<testing::PlantedMode> planted{{{62.0, 0.03}}, {{118.0, 0.02}}, {{260.0, 0.03}}};

// Sampled somewhat faster than the times say.
std::string recording_of(const std::vector<double>& times_s) {
  const analysis::Recording recording = testing::planted_recording(
      planted, times_s, stated_hz * (1.0 + wrong_by), times_s.back() + 1.3, 0.01, 3);
  std::string text = "time_s,acceleration\n";
  for (std::size_t n = 0; n < recording.samples.size(); ++n) {
    text +=
        fmt::format("{:.7f},{:.7g}\n", static_cast<double>(n) / stated_hz, recording.samples[n]);
  }
  return text;
}

runner::TapIdentification identified(const std::string& file, double rate_error) {
  runner::TapQuestion question;
  question.recordings = {file};
  question.band = analysis::Band{20.0, 400.0};
  question.rate_error = rate_error;
  runner::Progress progress{"identifying"};
  return runner::identify_taps(question, progress);
}

bool contains(const analysis::Estimate& estimate, double value) {
  return estimate.interval.low <= value && value <= estimate.interval.high;
}
}  // namespace

TEST_CASE("intervals hold what was planted although the rate is somewhat wrong",
          "[runner][identify]") {
  const testing::TempDirectory directory;
  const std::string file = directory / "taps.csv";
  testing::write(file, recording_of({0.4, 1.7, 3.0, 4.3}));
  const runner::TapIdentification found = identified(file, 0.001);
  const runner::TapIdentification trusting = identified(file, 0.0);
  REQUIRE(found.modes.size() == planted.size());
  for (std::size_t i = 0; i < planted.size(); ++i) {
    INFO(planted[i].pole.frequency_hz << " Hz");
    CHECK(contains(found.modes[i].frequency_hz, planted[i].pole.frequency_hz));
    CHECK(contains(found.modes[i].damping_ratio, planted[i].pole.damping_ratio));
    CHECK_FALSE(contains(trusting.modes[i].frequency_hz, planted[i].pole.frequency_hz));
  }
}

TEST_CASE("an error of the rate is one of alpha, against beta, and twice one of Young's modulus",
          "[runner][identify]") {
  runner::TapIdentification found;
  const analysis::Estimate sharp{100.0, 0.0, {100.0, 100.0}, {}};
  found.rayleigh.emplace();
  found.rayleigh->alpha_per_s = sharp;
  found.rayleigh->beta_s = sharp;
  found.model.emplace().update.emplace();
  found.model->update->youngs_modulus_pa = sharp;
  runner::include_rate_error(0.01, found);
  // all from f and zeta alone: alpha ~ f, beta ~ 1 / f, E ~ f^2, f between 1 / 1.01 and 1.01
  CHECK(found.rayleigh->alpha_per_s.interval.high == Approx(101.0));
  CHECK(found.rayleigh->beta_s.interval.low == Approx(100.0 / 1.01));
  CHECK(found.model->update->youngs_modulus_pa.interval.high == Approx(102.01));
  CHECK(found.model->update->youngs_modulus_pa.interval.low == Approx(100.0 / 1.0201));
}
