#include "runner/reproduction/tap_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/tables/cells.hpp"
#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) {
    most = std::max(most, std::abs(value));
  }
  return most;
}

// What is left of the discrete Fourier transform below a frequency.
std::vector<double> below(const std::vector<double>& values, double limit_hz, double rate_hz) {
  const auto count = static_cast<double>(values.size());
  std::vector<double> kept(values.size(), 0.0);
  for (double bin = 0.0; bin * rate_hz / count < limit_hz; ++bin) {
    const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * bin / count);
    std::complex<double> phasor{1.0, 0.0};
    std::complex<double> sum{0.0, 0.0};
    for (const double value : values) {
      sum += value * std::conj(phasor);
      phasor *= turn;
    }
    sum *= (bin == 0.0 ? 1.0 : 2.0) / count;
    phasor = {1.0, 0.0};
    for (double& value : kept) {
      value += (sum * phasor).real();
      phasor *= turn;
    }
  }
  return kept;
}
}  // namespace

TapForce tap_force(const std::vector<core::TraceSample>& trace, double rate_hz) {
  const auto impact = std::ranges::find(trace, true, &core::TraceSample::impact);
  if (impact == trace.end()) {
    throw core::InvalidInput{"a tap without an impact has no vibration"};
  }
  TapForce force;
  for (auto sample = impact; sample != trace.end(); ++sample) {
    force.t_s.push_back(1e-9 * static_cast<double>(sample->t_ns - impact->t_ns));
    force.penalty.push_back(sample->penalty_n);
    force.vibration.push_back(sample->vibration_n);
  }
  force.penalty_n = largest(force.penalty);
  force.vibration_n = largest(force.vibration);
  const std::vector<double> low = below(force.vibration, low_limit_hz, rate_hz);
  std::vector<double> high = force.vibration;
  std::ranges::transform(high, low, high.begin(), std::minus{});
  force.low_n = largest(low);
  force.high_n = largest(high);
  return force;
}

namespace {
constexpr double width = 300.0;
constexpr double left = 34.0;
constexpr double right = 296.0;
constexpr double top_n = 8.0;  // of the upper axis
constexpr double vibration_range_n = 1.0;
constexpr double upper_zero = 84.0;
constexpr double n_to_px = 9.0;
constexpr double lower_zero = 130.0;
constexpr double vibration_to_px = 34.0;
constexpr double height = 184.0;

double place(double t_s) {
  return left + (right - left) * t_s / shown_s;
}

template <class Y>
std::string curve(const char* css, const TapForce& force, const Y& y) {
  std::string path;
  for (std::size_t i = 0; i < force.t_s.size() && force.t_s[i] <= shown_s; ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', place(force.t_s[i]), y(i));
  }
  return fmt::format("<path class={} d=\"{}\"/>", css, path);
}

std::string axis(double zero, double high, const char* at_high) {
  return fmt::format(
      "<path class=frame d=\"M{0} {1:.1f}V{2:.1f}H{3}\"/><text x={4} y={5:.1f} "
      "text-anchor=end>{6}</text><text x={4} y={7:.1f} text-anchor=end>0</text>",
      left, high, zero, right, left - 4.0, high + 8.0, at_high, zero + 4.0);
}
}  // namespace

std::string force_svg(const TapForce& force, const std::string& title) {
  const std::string caption =
      fmt::format("{}: penalty {} N, vibration {} N at most", title,
                  analysis::rounded(force.penalty_n), analysis::rounded(force.vibration_n));
  const auto clipped = [](double value, double most) { return std::clamp(value, -most, most); };
  return fmt::format(
             "<figure><svg class=\"chart force\" viewBox=\"0 0 {} {}\" role=img aria-label=\"{}\">",
             width, height, analysis::escaped(caption)) +
         axis(upper_zero, upper_zero - top_n * n_to_px, "8 N") +
         curve("line", force,
               [&](std::size_t i) {
                 return upper_zero -
                        n_to_px * clipped(force.penalty[i] + force.vibration[i], top_n);
               }) +
         axis(lower_zero, lower_zero - vibration_range_n * vibration_to_px, "1 N") +
         curve("alone", force,
               [&](std::size_t i) {
                 return lower_zero -
                        vibration_to_px * clipped(force.vibration[i], vibration_range_n);
               }) +
         fmt::format("<text x={:.1f} y={} text-anchor=end>0.3 s</text>", right, height - 6.0) +
         fmt::format("</svg><figcaption>{}</figcaption></figure>\n", analysis::escaped(caption));
}
}  // namespace tapstudy::runner
