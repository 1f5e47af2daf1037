#pragma once
#include <cstddef>
#include <vector>

#include "core/settings/render_settings.hpp"
namespace tapstudy::core {
// Where a frequency lies among a response's points on a logarithmic axis: `share` of the way from
// one to the next. Beyond the outer points both are the nearest one.
struct PlaceInResponse {
  std::size_t from;
  std::size_t to;
  double share;
};
PlaceInResponse place_in(const DeviceResponse& response, double frequency_hz);

// The gain of a commanded vibration; beyond the outer points that of the nearest one.
double gain_at(double frequency_hz, const DeviceResponse& response);
// By what the command of a vibration is multiplied: the inverse of the gain, at most max_boost.
double boost_at(double frequency_hz, const DeviceResponse& response);

// The command that makes the device render the signal: filtered by the inverse of the device's
// magnitude response, with the phase of a minimum-phase system (Oppenheim & Schafer 2010, ch. 13),
// so that nothing is felt before the impact. Exact for a device that is itself of minimum phase; a
// delay beyond that is not undone. The end may be longer by what the inverse rings on. samples: at
// least one; the response's frequencies at or above half of the rate have no effect.
std::vector<double> compensated(const std::vector<double>& samples, const DeviceResponse& response,
                                double rate_hz);
}  // namespace tapstudy::core
