#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/recordings/taps.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t min_run = 3;
constexpr double smooth_steps = 3.0;
constexpr std::size_t min_noisy_run = 4;
constexpr double noise_tolerance = 3.0;
constexpr double limited_steps = 6.0;

// The least difference between successive samples, 0 if all are equal.
double resolution_of(const std::vector<double>& samples) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step = std::abs(samples[i] - samples[i - 1]);
    if (step > 0.0) {
      least = std::min(least, step);
    }
  }
  return std::isfinite(least) ? least : 0.0;
}

// How far the signal moves at either end of a run, at most.
double step_beside(const std::vector<double>& samples, std::size_t begin, std::size_t end) {
  const double before = begin > 0 ? std::abs(samples[begin - 1] - samples[begin]) : 0.0;
  const double after = end < samples.size() ? std::abs(samples[end] - samples[begin]) : 0.0;
  return std::max(before, after);
}

// Runs within a tolerance of the extreme; is_rail gets the run's end points.
template <class IsRail>
void add_runs_at(double extreme, double tolerance, const std::vector<double>& samples,
                 IsRail is_rail, std::vector<std::size_t>& rails) {
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i;
    while (end < samples.size() && std::abs(samples[end] - extreme) <= tolerance) {
      ++end;
    }
    if (end > i && is_rail(i, end)) {
      rails.resize(rails.size() + end - i);
      std::iota(rails.end() - static_cast<std::ptrdiff_t>(end - i), rails.end(), i);
    }
    i = std::max(end, i + 1);
  }
}

double spread_of(const std::vector<double>& samples, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t i) { return samples.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto [low, high] = std::minmax_element(at(begin), at(end));
  return *high - *low;
}
}  // namespace

std::vector<std::size_t> rail_samples(const std::vector<double>& samples, double noise_rms) {
  std::vector<std::size_t> rails;
  if (samples.empty()) {
    return rails;
  }
  const auto [low, high] = std::ranges::minmax(samples);
  if (low == high) {
    return rails;
  }
  const double resolution = resolution_of(samples);
  const auto is_flat = [&](std::size_t begin, std::size_t end) {
    return end - begin >= min_run && step_beside(samples, begin, end) > smooth_steps * resolution;
  };
  // A smooth peak moves at the end of the run by at most three times what it does within it.
  const auto is_limited = [&](std::size_t begin, std::size_t end) {
    return end - begin >= min_noisy_run &&
           step_beside(samples, begin, end) >
               limited_steps * std::max({spread_of(samples, begin, end), resolution, noise_rms});
  };
  for (const double extreme : {low, high}) {
    add_runs_at(extreme, 0.0, samples, is_flat, rails);
    add_runs_at(extreme, noise_tolerance * noise_rms, samples, is_limited, rails);
  }
  std::ranges::sort(rails);
  rails.erase(std::unique(rails.begin(), rails.end()), rails.end());
  return rails;
}
}  // namespace tapstudy::analysis
