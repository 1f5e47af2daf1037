#include "analysis/rendered/tap_cutter.hpp"

#include <cmath>
#include <utility>

#include "core/placement.hpp"
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
}  // namespace tapstudy::analysis
