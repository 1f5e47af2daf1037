#include "core/techniques/resampled.hpp"

#include <samplerate.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
// Longer than the filter's ringing.
constexpr std::size_t least_lead = 256;
constexpr std::size_t most_lead = 1256;

// Samples before the first one, in ticks of the new rate: so many that they are a whole number of
// the old rate's, where there is such a number.
struct Lead {
  std::size_t old_samples;
  std::size_t new_samples;
};
Lead lead_of(double from_hz, double to_hz) {
  constexpr double whole = 1e-6;
  const auto old_samples = [&](std::size_t count) {
    return static_cast<double>(count) * from_hz / to_hz;
  };
  std::size_t count = least_lead;
  while (count < most_lead &&
         std::abs(old_samples(count) - std::round(old_samples(count))) > whole) {
    ++count;
  }
  return {static_cast<std::size_t>(std::llround(old_samples(count))), count};
}

// Mirrored in its first point: a symmetric filter then leaves that point as it is.
std::vector<float> with_lead(const std::vector<double>& samples, std::size_t lead) {
  std::vector<float> led;
  led.reserve(lead + samples.size());
  for (std::size_t i = lead; i > 0; --i) {
    const double mirrored = i < samples.size() ? samples[i] : 0.0;
    led.push_back(static_cast<float>(2.0 * samples.front() - mirrored));
  }
  std::ranges::transform(samples, std::back_inserter(led),
                         [](double x) { return static_cast<float>(x); });
  return led;
}
}  // namespace

std::vector<double> resampled(const std::vector<double>& samples, double from_hz, double to_hz) {
  if (from_hz == to_hz || samples.empty()) {
    return samples;
  }
  const double ratio = to_hz / from_hz;
  const Lead lead = lead_of(from_hz, to_hz);
  const std::vector<float> in = with_lead(samples, lead.old_samples);
  const auto wanted =
      static_cast<std::size_t>(std::ceil(static_cast<double>(samples.size()) * ratio));
  std::vector<float> out(lead.new_samples + wanted);
  SRC_DATA data{};
  data.data_in = in.data();
  data.input_frames = static_cast<long>(in.size());
  data.data_out = out.data();
  data.output_frames = static_cast<long>(out.size());
  data.src_ratio = ratio;
  if (const int error = src_simple(&data, SRC_SINC_BEST_QUALITY, 1); error != 0) {
    throw InvalidInput{std::string{"resampling: "} + src_strerror(error)};
  }
  out.resize(static_cast<std::size_t>(data.output_frames_gen));
  const std::size_t begin = std::min(lead.new_samples, out.size());
  return {out.begin() + static_cast<std::ptrdiff_t>(begin), out.end()};
}
}  // namespace tapstudy::core
