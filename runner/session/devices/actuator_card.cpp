#include "runner/session/devices/actuator_card.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/error.hpp"
#include "device/audio/alsa_sink.hpp"
#include "device/device.hpp"
#include "device/loop/realtime.hpp"
#include "runner/session/devices/device_kind.hpp"
namespace tapstudy::runner {
namespace {
// A card's own filter falls off beyond.
constexpr double max_band_of_rate = 0.45;
}  // namespace

void check_actuator(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  const auto& crossover = protocol.rendering.crossover;
  if (!crossover) {
    return;
  }
  if (!rig.actuator && kind_of(rig).has_participant()) {
    throw core::InvalidInput{
        fmt::format("the protocol's rendering.crossover_hz leaves vibration above {} Hz to an "
                    "actuator, and the rig has no section 'actuator'",
                    crossover->low_hz)};
  }
  if (rig.actuator && protocol.band_limit_hz > max_band_of_rate * rig.actuator->rate_hz) {
    throw core::InvalidInput{fmt::format(
        "rendering.band_limit_hz {} is beyond what the rig's actuator.rate_hz {} plays "
        "(at most {:.0f} Hz)",
        protocol.band_limit_hz, rig.actuator->rate_hz, max_band_of_rate * rig.actuator->rate_hz)};
  }
}

const core::ActuatorOutput* actuator_of(const protocols::Protocol& protocol,
                                        const protocols::Rig& rig) {
  return protocol.rendering.crossover && rig.actuator ? &*rig.actuator : nullptr;
}

std::unique_ptr<device::PcmSink> open_actuator_card(const core::ActuatorOutput& actuator) {
  auto card = device::open_alsa({.card = actuator.card,
                                 .rate_hz = actuator.rate_hz,
                                 .period_s = device::actuator_period_s,
                                 .periods = device::actuator_buffer_periods,
                                 .channels = actuator.channels,
                                 .only_channel = actuator.channel - 1});
  const double delay_s = device::actuator_delay_s(*card);
  constexpr double rounding_s = 1e-6;
  if (delay_s > actuator.max_delay_s + rounding_s) {
    throw device::DeviceError{fmt::format(
        "actuator: card '{}' plays {:.1f} ms after a tick (at most actuator.max_delay_s, "
        "{:.1f} ms): a card itself, as in hw:CARD=NAME, buffers less than `default`",
        actuator.card, 1e3 * delay_s, 1e3 * actuator.max_delay_s)};
  }
  return card;
}

std::unique_ptr<device::ActuatorPlayer> actuator_player(const core::ActuatorOutput& actuator,
                                                        const protocols::Protocol& protocol,
                                                        const protocols::Rig& rig) {
  return std::make_unique<device::ActuatorPlayer>(
      open_actuator_card(actuator),
      device::ActuatorPlayer::Settings{actuator.full_scale_n, actuator.limits,
                                       protocol.rendering.dt_s, actuator.max_gaps,
                                       device::below(rig.realtime), protocol.stores_actuator});
}
}  // namespace tapstudy::runner
