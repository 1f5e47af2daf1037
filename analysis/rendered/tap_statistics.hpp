#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "analysis/rendered/tap_cutter.hpp"
namespace tapstudy::analysis {
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
