#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::analysis {
// One tick of a tap: forces on the finger along the outward normal [N].
struct TracedTick {
  core::ForceParts parts{};  // before the limiter
  double commanded_n{};      // magnitude of the commanded force, after the limiter
  double reported_n{};       // magnitude of the force that the device reports; NaN: it does not
  bool is_touching{};
};

// A tap as it was felt. ticks[k] is k periods of the loop after the impact: where ticks were
// skipped the force of the tick before, which the device held. Out of contact forces are zero.
struct TracedTap {
  std::array<double, 3> position_m{};  // of the hand at the impact, device frame
  double speed_m_s{};                  // along the normal, towards the plate
  std::uint8_t alternative{};          // that was rendered, from 0
  std::vector<TracedTick> ticks;       // never empty
};

// What a tap is.
struct TapWindow {
  double rate_hz{1000.0};
  double length_s{0.2};    // from its impact on; shorter where the next tap begins before
  double rebound_s{0.05};  // an impact so soon after the finger came off belongs to the tap before
  std::size_t ticks() const { return static_cast<std::size_t>(length_s * rate_hz + 0.5); }
};

// Cuts the taps out of traces, sample by sample: holds one tap at a time. A tap ends at the end of
// its window, at the next tap, at a switch to another alternative, at a fault and with its trial.
class TapCutter {
 public:
  using Take = std::function<void(const TracedTap&)>;
  TapCutter(const TapWindow& window, Take take);
  // Samples of one trial, in order.
  void add(const core::TraceSample& sample);
  void end_trial();

 private:
  bool begins_tap(const core::TraceSample& sample) const;
  void begin(const core::TraceSample& sample);
  void continue_with(const core::TraceSample& sample);
  void finish();

  TapWindow window_;
  Take take_;
  TracedTap tap_;              // without ticks: none is under way
  std::int64_t impact_ns_{};   // of the tap
  std::int64_t release_ns_{};  // the first tick without contact since the last one in contact
  bool was_touching_{};
  bool has_touched_{};  // since the trial began, or the switch
  std::uint8_t alternative_{};
};

// Mean and spread of one quantity at each tick after the impact, over taps (Welford 1962).
class TickMoments {
 public:
  explicit TickMoments(std::size_t ticks) : mean_(ticks, 0.0), squares_(ticks, 0.0) {}
  // n: how many taps there are at this tick, with this one
  void add(std::size_t tick, double value, std::int64_t n);
  double mean(std::size_t tick) const { return mean_[tick]; }
  // With n - 1; NaN of one tap.
  double standard_deviation(std::size_t tick, std::int64_t n) const;

 private:
  std::vector<double> mean_;
  std::vector<double> squares_;  // sum of squared distances from the mean
};

// Largest magnitude and root mean square of one part of the force. The square is over ticks in
// contact.
struct ForceExtent {
  std::string part;               // "contact_spring" ...
  std::vector<double> peaks_n{};  // of each tap
  double squares_n2{};
  std::int64_t ticks{};
  double rms_n() const;   // NaN without ticks
  double peak_n() const;  // of all taps; NaN without
};

// The taps of one stimulus, at one point or at all: what is kept does not grow with the length of
// traces, but for one number of each part a tap.
class TapStatistics {
 public:
  explicit TapStatistics(const TapWindow& window);
  void add(const TracedTap& tap);

  std::int64_t taps() const { return taps_at_.empty() ? 0 : taps_at_.front(); }
  const TapWindow& window() const { return window_; }
  const std::vector<double>& speeds_m_s() const { return speeds_m_s_; }
  // Contact spring, vibration, sinusoid, their sum, commanded, reported by the device: those that
  // are zero or unknown throughout have no RMS above zero.
  const std::array<ForceExtent, 6>& extents() const { return extents_; }
  const ForceExtent& commanded() const { return extents_[4]; }

  // So many ticks after the impact: taps that last so long, and their forces.
  std::size_t ticks() const { return taps_at_.size(); }
  std::int64_t taps_at(std::size_t tick) const { return taps_at_[tick]; }
  double mean_total_n(std::size_t tick) const { return total_.mean(tick); }
  double spread_total_n(std::size_t tick) const;
  double mean_added_n(std::size_t tick) const { return added_.mean(tick); }
  double spread_added_n(std::size_t tick) const;
  bool has_added() const;  // the technique adds something to the contact spring

  // Root mean square over taps of |dt sum_k f_k exp(-2 pi i k m / N)| of the force f that is added
  // to the contact spring, m = 0 … N/2, zero after the tap's end [N s, that is N/Hz].
  std::vector<double> spectrum_n_per_hz() const;
  double frequency_hz(std::size_t m) const;

 private:
  void add_extents(const TracedTick& tick, std::array<double, 6>& peaks_n);
  void add_spectrum(const TracedTap& tap);

  TapWindow window_;
  std::vector<double> speeds_m_s_;
  std::array<ForceExtent, 6> extents_;
  std::vector<std::int64_t> taps_at_;
  TickMoments total_;
  TickMoments added_;
  Eigen::ArrayXd power_;  // sum over taps of squared magnitudes
};
}  // namespace tapstudy::analysis
