#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/recordings/taps.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t min_run = 3;
constexpr double smooth_steps = 3.0;

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

void add_runs_at(double extreme, const std::vector<double>& samples, double resolution,
                 std::vector<std::size_t>& rails) {
  for (std::size_t i = 0; i < samples.size();) {
    std::size_t end = i;
    while (end < samples.size() && samples[end] == extreme) {
      ++end;
    }
    if (end - i >= min_run && step_beside(samples, i, end) > smooth_steps * resolution) {
      rails.resize(rails.size() + end - i);
      std::iota(rails.end() - static_cast<std::ptrdiff_t>(end - i), rails.end(), i);
    }
    i = std::max(end, i + 1);
  }
}
}  // namespace

std::vector<std::size_t> rail_samples(const std::vector<double>& samples) {
  std::vector<std::size_t> rails;
  if (samples.empty()) {
    return rails;
  }
  const auto [low, high] = std::ranges::minmax(samples);
  if (low == high) {
    return rails;
  }
  const double resolution = resolution_of(samples);
  add_runs_at(high, samples, resolution, rails);
  add_runs_at(low, samples, resolution, rails);
  std::ranges::sort(rails);
  return rails;
}
}  // namespace tapstudy::analysis
