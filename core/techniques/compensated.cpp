#include "core/techniques/compensated.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <functional>
#include <iterator>
#include <unsupported/Eigen/FFT>
namespace tapstudy::core {
namespace {
using Spectrum = std::vector<std::complex<double>>;

// The transform is long enough that the cepstrum of a measured response does not wrap around.
constexpr std::size_t least_length = 4096;
// Threshold of the inverse's impulse response, relative to its largest value.
constexpr double silence = 1e-5;

std::vector<double> inverse_transform(const Spectrum& spectrum) {
  Eigen::FFT<double> transform;
  std::vector<double> samples;
  transform.inv(samples, spectrum);
  return samples;
}

Spectrum transform_of(std::vector<double> samples, std::size_t length) {
  samples.resize(length, 0.0);
  Eigen::FFT<double> transform;
  Spectrum spectrum;
  transform.fwd(spectrum, samples);
  return spectrum;
}

// The causal signal whose spectrum has this logarithmic magnitude: the cepstrum's negative times
// are folded onto the positive ones.
std::vector<double> minimum_phase(const std::vector<double>& log_magnitude) {
  const std::size_t length = log_magnitude.size();
  std::vector<double> cepstrum =
      inverse_transform(Spectrum{log_magnitude.begin(), log_magnitude.end()});
  for (std::size_t i = 1; i < length; ++i) {
    cepstrum[i] *= i < length / 2 ? 2.0 : (i == length / 2 ? 1.0 : 0.0);
  }
  Spectrum spectrum = transform_of(cepstrum, length);
  std::ranges::transform(spectrum, spectrum.begin(),
                         [](const std::complex<double>& value) { return std::exp(value); });
  return inverse_transform(spectrum);
}

// Removes the silence at the end of the filter.
void trim(std::vector<double>& filter) {
  const auto magnitude = [](double x) { return std::abs(x); };
  const double largest = std::abs(*std::ranges::max_element(filter, {}, magnitude));
  const auto last = std::find_if(filter.rbegin(), filter.rend(),
                                 [&](double x) { return std::abs(x) > silence * largest; });
  filter.erase(last.base(), filter.end());
}

std::vector<double> inverse_filter(const DeviceResponse& response, double rate_hz,
                                   std::size_t length) {
  std::vector<double> log_magnitude(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double frequency_hz =
        rate_hz * static_cast<double>(std::min(i, length - i)) / static_cast<double>(length);
    log_magnitude[i] = std::log(boost_at(frequency_hz, response));
  }
  std::vector<double> filter = minimum_phase(log_magnitude);
  filter.resize(length / 2);
  trim(filter);
  return filter;
}
}  // namespace

PlaceInResponse place_in(const DeviceResponse& response, double frequency_hz) {
  const std::vector<DeviceResponse::Point>& points = response.points;
  const auto above =
      std::ranges::lower_bound(points, frequency_hz, {}, &DeviceResponse::Point::frequency_hz);
  const auto to = static_cast<std::size_t>(std::distance(points.begin(), above));
  if (above == points.begin()) {
    return {0, 0, 0.0};
  }
  if (above == points.end()) {
    return {to - 1, to - 1, 0.0};
  }
  const double from_hz = points[to - 1].frequency_hz;
  return {to - 1, to, std::log(frequency_hz / from_hz) / std::log(above->frequency_hz / from_hz)};
}

double gain_at(double frequency_hz, const DeviceResponse& response) {
  const PlaceInResponse place = place_in(response, frequency_hz);
  const double from = response.points[place.from].gain;
  return from * std::pow(response.points[place.to].gain / from, place.share);
}

double boost_at(double frequency_hz, const DeviceResponse& response) {
  return std::min(response.max_boost, 1.0 / gain_at(frequency_hz, response));
}

std::vector<double> compensated(const std::vector<double>& samples, const DeviceResponse& response,
                                double rate_hz) {
  const std::size_t length = std::bit_ceil(std::max(least_length, 2 * samples.size()));
  const std::vector<double> filter = inverse_filter(response, rate_hz, length);
  const std::size_t all = samples.size() + filter.size() - 1;
  const std::size_t padded = std::bit_ceil(all);
  Spectrum product = transform_of(samples, padded);
  const Spectrum of_filter = transform_of(filter, padded);
  std::ranges::transform(product, of_filter, product.begin(), std::multiplies<>{});
  std::vector<double> commanded = inverse_transform(product);
  commanded.resize(all);
  return commanded;
}
}  // namespace tapstudy::core
