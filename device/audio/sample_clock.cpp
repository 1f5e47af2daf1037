#include "device/audio/sample_clock.hpp"

#include <cmath>
#include <numbers>
namespace tapstudy::device {
namespace {
constexpr double bandwidth_hz = 0.2;
constexpr double settling_ns = 1e9;
constexpr double max_error_periods = 2.0;
}  // namespace

SampleClock::SampleClock(double rate_hz, double period_frames) noexcept
    : frames_{period_frames},
      nominal_ns_{1e9 * period_frames / rate_hz},
      b_{std::numbers::sqrt2 * 2.0 * std::numbers::pi * bandwidth_hz * 1e-9 * nominal_ns_},
      c_{0.5 * b_ * b_},
      period_ns_{nominal_ns_} {}

void SampleClock::measured(double heard_at_ns) noexcept {
  const double error_ns = heard_at_ns - next_ns_;
  if (periods_ == 0 || std::abs(error_ns) > max_error_periods * nominal_ns_) {
    begins_ns_ = heard_at_ns;
    next_ns_ = heard_at_ns + nominal_ns_;
    period_ns_ = nominal_ns_;
    periods_ = 1;
    return;
  }
  begins_ns_ = next_ns_;
  next_ns_ += b_ * error_ns + period_ns_;
  period_ns_ += c_ * error_ns;
  if (static_cast<double>(++periods_) * nominal_ns_ > settling_ns) {
    squares_ns2_ += error_ns * error_ns;
    ++counted_;
  }
}

std::optional<double> SampleClock::jitter_s() const noexcept {
  return counted_ == 0
             ? std::nullopt
             : std::optional{1e-9 * std::sqrt(squares_ns2_ / static_cast<double>(counted_))};
}
}  // namespace tapstudy::device
