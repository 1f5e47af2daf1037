#include "core/techniques/divided_recording.hpp"

#include <algorithm>
#include <bit>
#include <complex>
#include <unsupported/Eigen/FFT>
#include <utility>
#include <vector>

#include "core/techniques/compensated.hpp"
#include "core/techniques/resampled.hpp"
namespace tapstudy::core {
namespace {
std::vector<double> actuators_share(const std::vector<double>& samples, double rate_hz,
                                    const Crossover& crossover) {
  std::vector<double> padded = samples;
  const std::size_t length = std::bit_ceil(2 * samples.size());
  padded.resize(length, 0.0);
  Eigen::FFT<double> transform;
  std::vector<std::complex<double>> spectrum;
  transform.fwd(spectrum, padded);
  spectrum[0] = 0.0;
  for (std::size_t i = 1; i < length; ++i) {
    const auto bin = static_cast<double>(std::min(i, length - i));
    spectrum[i] *= crossover.actuator_share(rate_hz * bin / static_cast<double>(length));
  }
  transform.inv(padded, spectrum);
  padded.resize(samples.size());
  return padded;
}
}  // namespace

RecordedTaps share_of(const RecordedTaps& recorded, const Crossover& crossover, RenderedBy by) {
  RecordedTaps part = recorded;
  for (RecordedTap& tap : part.taps) {
    std::vector<double> share_n = actuators_share(tap.force_n, recorded.rate_hz, crossover);
    if (by == RenderedBy::device) {
      std::ranges::transform(tap.force_n, share_n, share_n.begin(), std::minus<>{});
    }
    tap.force_n = std::move(share_n);
  }
  return part;
}

RecordedTransient recorded_by(RenderedBy by, const RenderSettings& settings,
                              const DeviceResponse* response, double rate_hz) {
  RecordedTaps recorded = settings.crossover
                              ? share_of(*settings.recorded_taps, *settings.crossover, by)
                              : *settings.recorded_taps;
  for (RecordedTap& tap : recorded.taps) {
    tap.force_n = resampled(tap.force_n, recorded.rate_hz, rate_hz);
    if (response != nullptr) {
      tap.force_n = compensated(tap.force_n, *response, rate_hz);
    }
  }
  return {std::move(recorded.taps), settings.vibration_gain};
}
}  // namespace tapstudy::core
