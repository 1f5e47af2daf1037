#include "core/techniques/resampled.hpp"

#include <samplerate.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
namespace tapstudy::core {
std::vector<double> resampled(const std::vector<double>& samples, double from_hz, double to_hz) {
  if (from_hz == to_hz) {
    return samples;
  }
  const double ratio = to_hz / from_hz;
  std::vector<float> in(samples.size());
  std::ranges::transform(samples, in.begin(), [](double x) { return static_cast<float>(x); });
  std::vector<float> out(
      static_cast<std::size_t>(std::ceil(static_cast<double>(samples.size()) * ratio)));
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
  return {out.begin(), out.end()};
}
}  // namespace tapstudy::core
