#include "analysis/report/study/rendered_taps.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::analysis {
namespace {
double magnitude(const std::array<double, 3>& vector) {
  return std::hypot(vector[0], vector[1], vector[2]);
}

TracedTick felt(const core::TraceSample& sample) {
  return {{sample.penalty_n, sample.vibration_n, sample.sinusoid_n},
          magnitude(sample.force_n),
          magnitude(sample.achieved_n),
          sample.touching};
}
}  // namespace

TapCutter::TapCutter(const TapWindow& window, Take take)
    : window_{window}, take_{std::move(take)} {}

void TapCutter::finish() {
  if (!tap_.ticks.empty()) {
    take_(tap_);
    tap_.ticks.clear();
  }
}

void TapCutter::end_trial() {
  finish();
  was_touching_ = false;
  has_touched_ = false;
}

bool TapCutter::begins_tap(const core::TraceSample& sample) const {
  if (!sample.impact) {
    return false;
  }
  const double away_s = 1e-9 * static_cast<double>(sample.t_ns - release_ns_);
  return !has_touched_ || (!was_touching_ && away_s >= window_.rebound_s);
}

void TapCutter::begin(const core::TraceSample& sample) {
  finish();
  tap_.position_m = sample.position_m;
  tap_.speed_m_s = -core::along_normal(sample.velocity_m_s);
  tap_.alternative = sample.alternative;
  tap_.ticks.push_back(felt(sample));
  impact_ns_ = sample.t_ns;
}

void TapCutter::continue_with(const core::TraceSample& sample) {
  const double since_s = 1e-9 * static_cast<double>(sample.t_ns - impact_ns_);
  const auto place = static_cast<std::size_t>(std::lround(since_s * window_.rate_hz));
  while (tap_.ticks.size() < std::min(place, window_.ticks())) {
    tap_.ticks.push_back(TracedTick{tap_.ticks.back()});
  }
  if (place >= window_.ticks()) {
    finish();
  } else if (place == tap_.ticks.size()) {
    tap_.ticks.push_back(felt(sample));
  }
}

void TapCutter::add(const core::TraceSample& sample) {
  if (sample.fault != core::TickFault::none || sample.alternative != alternative_) {
    end_trial();
    alternative_ = sample.alternative;
  }
  if (sample.fault != core::TickFault::none) {
    return;
  }
  if (begins_tap(sample)) {
    begin(sample);
  } else if (!tap_.ticks.empty()) {
    continue_with(sample);
  }
  if (was_touching_ && !sample.touching) {
    release_ns_ = sample.t_ns;
  }
  has_touched_ = has_touched_ || sample.touching;
  was_touching_ = sample.touching;
}

namespace {
double added_n(const TracedTick& tick) {
  return tick.parts.vibration_n + tick.parts.sinusoid_n;
}

std::array<double, 6> forces_of(const TracedTick& tick) {
  return {tick.parts.penalty_n, tick.parts.vibration_n, tick.parts.sinusoid_n,
          tick.parts.total_n(), tick.commanded_n,       tick.reported_n};
}
}  // namespace

void TickMoments::add(std::size_t tick, double value, std::int64_t n) {
  const double before = value - mean_[tick];
  mean_[tick] += before / static_cast<double>(n);
  squares_[tick] += before * (value - mean_[tick]);
}

double TickMoments::standard_deviation(std::size_t tick, std::int64_t n) const {
  return n < 2 ? std::numeric_limits<double>::quiet_NaN()
               : std::sqrt(squares_[tick] / static_cast<double>(n - 1));
}

double ForceExtent::rms_n() const {
  return std::sqrt(squares_n2 / static_cast<double>(ticks));
}

double ForceExtent::peak_n() const {
  return peaks_n.empty() ? std::numeric_limits<double>::quiet_NaN() : std::ranges::max(peaks_n);
}

TapStatistics::TapStatistics(const TapWindow& window)
    : window_{window},
      extents_{{{"contact spring"},
                {"vibration"},
                {"decaying sinusoid"},
                {"total"},
                {"commanded"},
                {"reported"}}},
      taps_at_(window.ticks(), 0),
      total_{window.ticks()},
      added_{window.ticks()},
      power_{Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(window.ticks() / 2 + 1))} {}

void TapStatistics::add_extents(const TracedTick& tick, std::array<double, 6>& peaks_n) {
  const std::array<double, 6> forces = forces_of(tick);
  for (std::size_t part = 0; part < forces.size(); ++part) {
    if (!tick.is_touching || std::isnan(forces[part])) {
      continue;
    }
    peaks_n[part] = std::max(peaks_n[part], std::abs(forces[part]));
    extents_[part].squares_n2 += forces[part] * forces[part];
    ++extents_[part].ticks;
  }
}

void TapStatistics::add_spectrum(const TracedTap& tap) {
  std::vector<double> force(window_.ticks(), 0.0);
  std::ranges::transform(tap.ticks, force.begin(), added_n);
  std::vector<std::complex<double>> transformed;
  Eigen::FFT<double> transform;
  transform.fwd(transformed, force);
  for (Eigen::Index m = 0; m < power_.size(); ++m) {
    power_[m] += std::norm(transformed[static_cast<std::size_t>(m)]);
  }
}

void TapStatistics::add(const TracedTap& tap) {
  std::array<double, 6> peaks_n{};
  speeds_m_s_.push_back(tap.speed_m_s);
  for (std::size_t k = 0; k < tap.ticks.size(); ++k) {
    const TracedTick& tick = tap.ticks[k];
    ++taps_at_[k];
    total_.add(k, tick.parts.total_n(), taps_at_[k]);
    added_.add(k, added_n(tick), taps_at_[k]);
    add_extents(tick, peaks_n);
  }
  for (std::size_t part = 0; part < peaks_n.size(); ++part) {
    extents_[part].peaks_n.push_back(peaks_n[part]);
  }
  add_spectrum(tap);
}

double TapStatistics::spread_total_n(std::size_t tick) const {
  return total_.standard_deviation(tick, taps_at_[tick]);
}

double TapStatistics::spread_added_n(std::size_t tick) const {
  return added_.standard_deviation(tick, taps_at_[tick]);
}

bool TapStatistics::has_added() const {
  return extents_[1].squares_n2 + extents_[2].squares_n2 > 0.0;
}

std::vector<double> TapStatistics::spectrum_n_per_hz() const {
  std::vector<double> spectrum;
  for (const double power : power_) {
    spectrum.push_back(std::sqrt(power / static_cast<double>(taps())) / window_.rate_hz);
  }
  return spectrum;
}

double TapStatistics::frequency_hz(std::size_t m) const {
  return static_cast<double>(m) * window_.rate_hz / static_cast<double>(window_.ticks());
}
}  // namespace tapstudy::analysis
