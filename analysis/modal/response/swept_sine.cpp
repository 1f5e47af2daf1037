#include "analysis/modal/response/swept_sine.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using Complex = std::complex<double>;

constexpr double beyond = std::numbers::sqrt2;  // the band, at either end: half an octave
constexpr double max_of_rate = 0.45;
// Of the lowest frequency, in a sweep: with 40, and distortion, a filter's gain is found to 0.6 %.
constexpr double min_periods = 40.0;
// Of the impulse response; what comes later is of the next sweep.
constexpr double kept_after_s = 0.25;
constexpr double max_kept_before_s = 0.2;
constexpr double faded_share = 0.5;  // of either side, at its edge
static_assert(max_kept_before_s + kept_after_s < silence_after_sweep_s);

long frames_of(double seconds, const SweptSine& sweep) {
  return std::lround(seconds * sweep.rate_hz);
}
long frames_of_one(const SweptSine& sweep) {
  return frames_of(sweep.seconds + silence_after_sweep_s, sweep);
}

// L
double length_of(const SweptSine& sweep) {
  return std::log(sweep.to_hz * beyond / (sweep.from_hz / beyond));
}

// The second harmonic comes T ln 2 / L early: half of that is the linear response's.
double kept_before_s(const SweptSine& sweep) {
  return std::min(max_kept_before_s, 0.5 * sweep.seconds * std::numbers::ln2 / length_of(sweep));
}

// A half-octave at either end is faded.
std::vector<double> one_sweep(const SweptSine& sweep) {
  const double low_hz = sweep.from_hz / beyond;
  const double length = length_of(sweep);
  const double fade_s = sweep.seconds * std::log(beyond) / length;
  std::vector<double> samples(static_cast<std::size_t>(frames_of(sweep.seconds, sweep)));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / sweep.rate_hz;
    const double to_end_s = std::min(t, sweep.seconds - t);
    const double fade =
        to_end_s < fade_s ? 0.5 - 0.5 * std::cos(std::numbers::pi * to_end_s / fade_s) : 1.0;
    samples[i] = fade * std::sin(2.0 * std::numbers::pi * low_hz * sweep.seconds / length *
                                 std::expm1(t * length / sweep.seconds));
  }
  return samples;
}

std::vector<Complex> spectrum_of(std::span<const double> samples, std::size_t size) {
  std::vector<double> padded(samples.begin(), samples.end());
  padded.resize(size);
  std::vector<Complex> spectrum;
  Eigen::FFT<double>{}.fwd(spectrum, padded);
  return spectrum;
}

// 1 in the band, 0 beyond half an octave of it, where the sweep has little to divide by: the mean
// and the slow part of what a nonlinearity adds would be all that is seen.
double weight_at(double frequency_hz, const SweptSine& sweep) {
  const double octaves =
      std::max(std::log2(sweep.from_hz / frequency_hz), std::log2(frequency_hz / sweep.to_hz));
  return 0.5 + 0.5 * std::cos(std::numbers::pi * std::clamp(2.0 * octaves, 0.0, 1.0));
}

// The samples divided by one sweep: the impulse responses to each, one after the other, what is
// before the first at the end.
std::vector<double> divided_by(std::span<const double> sweep_samples,
                               std::span<const double> samples, const SweptSine& sweep) {
  const std::size_t size = std::bit_ceil(sweep_samples.size() + samples.size());
  const std::vector<Complex> x = spectrum_of(sweep_samples, size);
  std::vector<Complex> h = spectrum_of(samples, size);
  h[0] = 0.0;
  for (std::size_t i = 1; i < size; ++i) {
    const auto line = static_cast<double>(std::min(i, size - i));
    const double weight = weight_at(line * sweep.rate_hz / static_cast<double>(size), sweep);
    h[i] = weight > 0.0 ? weight * h[i] / x[i] : Complex{};
  }
  std::vector<double> response;
  Eigen::FFT<double>{}.inv(response, h);
  return response;
}

// Where in it the first of the sweeps is heard: the largest of all sums over their distance.
long first_peak(std::span<const double> response, const SweptSine& sweep) {
  const long apart = frames_of_one(sweep);
  const long last = static_cast<long>(response.size()) - (sweep.repeats - 1) * apart;
  long first = 0;
  double largest = 0.0;
  for (long at = 0; at < last; ++at) {
    double sum = 0.0;
    for (int k = 0; k < sweep.repeats; ++k) {
      sum += std::abs(response[static_cast<std::size_t>(at + k * apart)]);
    }
    if (sum > largest) {
      largest = sum;
      first = at;
    }
  }
  return first;
}

// Of the impulse response around a place, with the time counted from there: a direct sum, since
// frequencies are few and evenly spaced over a logarithm.
Complex at_frequency(const std::vector<double>& response, long place, double frequency_hz,
                     const SweptSine& sweep) {
  const long before = frames_of(kept_before_s(sweep), sweep);
  const long after = frames_of(kept_after_s, sweep);
  const double turn = -2.0 * std::numbers::pi * frequency_hz / sweep.rate_hz;
  const auto size = static_cast<long>(response.size());
  Complex sum{};
  for (long i = -before; i < after; ++i) {
    const auto at = static_cast<std::size_t>((place + i + size) % size);
    const auto to_edge = static_cast<double>(i < 0 ? before + i : after - i) /
                         static_cast<double>(i < 0 ? before : after);
    const double faded = to_edge < faded_share
                             ? 0.5 - 0.5 * std::cos(std::numbers::pi * to_edge / faded_share)
                             : 1.0;
    sum += faded * response[at] * std::polar(1.0, turn * static_cast<double>(i));
  }
  return sum;
}

double unwrapped(double phase_rad, double near_rad) {
  const double turn = 2.0 * std::numbers::pi;
  return phase_rad + turn * std::round((near_rad - phase_rad) / turn);
}

// The response to each sweep at one frequency, against the phase of the command where that is
// known.
std::vector<Complex> responses_at(double frequency_hz, const SweptSine& sweep, long place,
                                  const std::vector<double>& response,
                                  const std::vector<double>& command) {
  std::vector<Complex> all;
  for (int k = 0; k < sweep.repeats; ++k) {
    const long at = place + k * frames_of_one(sweep);
    Complex h = at_frequency(response, at, frequency_hz, sweep);
    if (!command.empty()) {
      h *= std::polar(1.0, -std::arg(at_frequency(command, at, frequency_hz, sweep)));
    }
    all.push_back(h);
  }
  return all;
}
}  // namespace

std::vector<double> samples_of(const SweptSine& sweep) {
  if (sweep.seconds * sweep.from_hz < min_periods) {
    throw core::InvalidInput{
        fmt::format("a sweep from {:g} Hz takes {:g} s at least: {} of its periods", sweep.from_hz,
                    min_periods / sweep.from_hz, min_periods)};
  }
  if (sweep.to_hz * beyond > max_of_rate * sweep.rate_hz) {
    throw core::InvalidInput{
        fmt::format("a sweep to {} Hz goes half an octave beyond, which {} Hz does not play",
                    sweep.to_hz, sweep.rate_hz)};
  }
  const std::vector<double> one = one_sweep(sweep);
  std::vector<double> all;
  for (int k = 0; k < sweep.repeats; ++k) {
    all.insert(all.end(), one.begin(), one.end());
    all.resize(static_cast<std::size_t>((k + 1) * frames_of_one(sweep)), 0.0);
  }
  return all;
}

SweptResponse response_to(const SweptSine& sweep, std::span<const double> recorded,
                          std::span<const double> reference, int points) {
  const auto needed = static_cast<std::size_t>(sweep.repeats * frames_of_one(sweep) -
                                               frames_of(silence_after_sweep_s, sweep));
  if (recorded.size() < needed) {
    throw core::InvalidInput{fmt::format("the recording is {:.2f} s long, the sweeps {:.2f} s",
                                         static_cast<double>(recorded.size()) / sweep.rate_hz,
                                         static_cast<double>(needed) / sweep.rate_hz)};
  }
  const std::vector<double> one = one_sweep(sweep);
  const std::vector<double> response = divided_by(one, recorded, sweep);
  const std::vector<double> command =
      reference.empty() ? std::vector<double>{} : divided_by(one, reference, sweep);
  const long place =
      first_peak(std::span{command.empty() ? response : command}.first(recorded.size()), sweep);
  SweptResponse found{{}, static_cast<double>(place) / sweep.rate_hz};
  double phase_rad = 0.0;
  for (int i = 0; i < points; ++i) {
    const double share = static_cast<double>(i) / std::max(1, points - 1);
    const double frequency_hz = sweep.from_hz * std::pow(sweep.to_hz / sweep.from_hz, share);
    Complex sum{};
    double squares = 0.0;
    for (const Complex& h : responses_at(frequency_hz, sweep, place, response, command)) {
      sum += h;
      squares += std::norm(h);
    }
    const double n = sweep.repeats;
    phase_rad = unwrapped(std::arg(sum), phase_rad);
    found.points.push_back({frequency_hz, std::abs(sum) / n, phase_rad,
                            squares > 0.0 ? std::norm(sum) / (n * squares) : 0.0});
  }
  return found;
}
}  // namespace tapstudy::analysis
