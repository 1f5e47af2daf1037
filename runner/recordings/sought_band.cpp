#include "runner/recordings/sought_band.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
constexpr double default_low_hz = 10.0;
constexpr double default_high_hz = 1000.0;
constexpr double usable_rate_share = 0.4;  // of the rate; sensors' own filters begin above
constexpr double max_rate_share = 0.47;
}  // namespace

analysis::Band sought_band(const TapQuestion& question, double rate_hz,
                           std::optional<double> band_limit_hz) {
  if (!question.band) {
    return {default_low_hz,
            std::min(usable_rate_share * rate_hz, band_limit_hz.value_or(default_high_hz))};
  }
  if (question.band->high_hz > max_rate_share * rate_hz) {
    throw core::InvalidInput{fmt::format("--band: ends at {:g} Hz, above {} of the rate of {:g} Hz",
                                         question.band->high_hz, max_rate_share, rate_hz)};
  }
  return *question.band;
}

analysis::Band band_of_sinusoid(const analysis::Band& sought, double rate_hz) {
  return {sought.low_hz,
          std::max(sought.high_hz, std::min(default_high_hz, usable_rate_share * rate_hz))};
}
}  // namespace tapstudy::runner
