#include "runner/participants/touch_features.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>

#include "core/placement.hpp"
namespace tapstudy::runner {
namespace {
using device::FeltTick;
constexpr double lowest_band_hz = 20.0;
constexpr double early_s = 0.04;
constexpr double late_s = 0.12;
constexpr double rebound_s = 0.05;            // a finger that is off for less bounces
constexpr double contact_threshold_n = 1e-6;  // threshold of contact detection

double normal_force_n(const FeltTick& tick) {
  return core::along_normal(tick.force_n);
}
double height_m(const FeltTick& tick) {
  return core::along_normal(tick.hand.position_m);
}

bool is_contact(const FeltTick& tick) {
  return std::abs(normal_force_n(tick)) > contact_threshold_n;
}

// The residuals of a linear least-squares fit of force against height in contact; out of contact
// the spring exerts nothing. For a hand that holds still, where a script taps, it is the mean.
std::vector<double> without_spring(std::span<const FeltTick> tap) {
  std::vector<FeltTick> contact;
  std::ranges::copy_if(tap, std::back_inserter(contact), is_contact);
  double mean_height = 0.0;
  double mean_force = 0.0;
  for (const FeltTick& tick : contact) {
    mean_height += height_m(tick);
    mean_force += normal_force_n(tick);
  }
  const auto count = static_cast<double>(contact.size());
  mean_height /= count;
  mean_force /= count;
  double covariance = 0.0;
  double variance = 0.0;
  for (const FeltTick& tick : contact) {
    const double height = height_m(tick) - mean_height;
    covariance += height * (normal_force_n(tick) - mean_force);
    variance += height * height;
  }
  const double slope = variance > 0.0 ? covariance / variance : 0.0;
  std::vector<double> rest;
  rest.reserve(tap.size());
  for (const FeltTick& tick : tap) {
    const bool is_predicted = is_contact(tick) || variance == 0.0;
    const double spring = mean_force + slope * (height_m(tick) - mean_height);
    rest.push_back(normal_force_n(tick) - (is_predicted ? spring : 0.0));
  }
  return rest;
}

// Mean square of the component at one frequency (Goertzel 1958, as a rotating phasor).
double power_at(std::span<const double> signal, double frequency_hz, double dt_s) {
  const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * frequency_hz * dt_s);
  std::complex<double> phasor{1.0, 0.0};
  std::complex<double> sum{0.0, 0.0};
  for (const double x : signal) {
    sum += x * phasor;
    phasor *= turn;
  }
  const auto count = static_cast<double>(signal.size());
  return 2.0 * std::norm(sum) / (count * count);
}

Features features_of(std::span<const FeltTick> tap, double dt_s, double threshold_n) {
  const std::vector<double> rest = without_spring(tap);
  const std::span<const double> all{rest};
  const auto early = std::min(all.size(), static_cast<std::size_t>(std::lround(early_s / dt_s)));
  const std::array windows{all.first(early), all.subspan(early)};
  const double threshold_power = 0.5 * threshold_n * threshold_n;
  Features levels{};
  for (std::size_t band = 0; band < bands; ++band) {
    const double frequency = lowest_band_hz * std::exp2(static_cast<double>(band) / 3.0);
    if (frequency >= 0.5 / dt_s) {
      break;  // above the loop's bandwidth, so not felt
    }
    for (std::size_t window = 0; window < windows.size(); ++window) {
      const double power = power_at(windows.at(window), frequency, dt_s);
      levels.at(window * bands + band) = 10.0 * std::log10(1.0 + power / threshold_power);
    }
  }
  return levels;
}
}  // namespace

std::vector<FeltTap> felt_taps(std::span<const FeltTick> felt, double dt_s, double threshold_n) {
  const auto whole = static_cast<std::size_t>(std::lround((early_s + late_s) / dt_s));
  const auto rebound = static_cast<std::ptrdiff_t>(std::lround(rebound_s / dt_s));
  std::vector<FeltTap> taps;
  for (auto first = std::ranges::find_if(felt, is_contact); first != felt.end();) {
    auto last = std::find_if_not(first, felt.end(), is_contact);
    auto next = std::find_if(last, felt.end(), is_contact);
    while (next != felt.end() && next - last < rebound) {
      last = std::find_if_not(next, felt.end(), is_contact);
      next = std::find_if(last, felt.end(), is_contact);
    }
    if (static_cast<std::size_t>(last - first) >= whole) {
      taps.push_back(
          {first->hand.position_m, features_of(std::span{first, whole}, dt_s, threshold_n)});
    }
    first = next;
  }
  return taps;
}
}  // namespace tapstudy::runner
