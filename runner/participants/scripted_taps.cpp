#include "runner/participants/scripted_taps.hpp"

#include "runner/participants/tap_drawing.hpp"
namespace tapstudy::runner {
std::optional<device::RepeatedTap> scripted_tap(
    const protocols::Protocol& protocol, const std::optional<protocols::ScriptedTaps>& taps) {
  if (!taps) {
    return std::nullopt;
  }
  return device::RepeatedTap{protocol.simulation.hand, point_on_surface_m(protocol, taps->point),
                             taps->speed_m_s, taps->dwell_s, taps->pause_s};
}
}  // namespace tapstudy::runner
