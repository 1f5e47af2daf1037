#include "runner/session/devices/masking_card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "device/audio/alsa_sink.hpp"
#include "device/audio/noise.hpp"
#include "device/device.hpp"
#include "device/loop/realtime.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
// Filters are exact up to here.
constexpr double max_edge_of_rate = 0.45;

std::string_view word_of(core::NoiseKind kind) {
  switch (kind) {
    case core::NoiseKind::white:
      return "white noise";
    case core::NoiseKind::pink:
      return "pink noise";
    case core::NoiseKind::band:
      break;
  }
  return "noise";
}

bool has_card(const protocols::Rig& rig) {
  return rig.has_hardware || rig.audio.has_value();
}

core::AudioOutput output_of(const protocols::Rig& rig) {
  return rig.audio.value_or(core::AudioOutput{});
}
}  // namespace

std::string described(const core::MaskingNoise& masking) {
  return fmt::format("{}{} at {} dB FS, ramps of {} s", word_of(masking.kind),
                     masking.kind == core::NoiseKind::band
                         ? fmt::format(" from {} to {} Hz", masking.low_hz, masking.high_hz)
                         : "",
                     masking.level_db_fs, masking.ramp_s);
}

void check_masking(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  if (!protocol.masking || !has_card(rig)) {
    return;
  }
  const core::AudioOutput audio = output_of(rig);
  const core::MaskingNoise& masking = *protocol.masking;
  if (masking.level_db_fs + audio.gain_db > core::max_noise_level_db_fs) {
    throw core::InvalidInput{fmt::format(
        "masking.level_db_fs {} with the rig's audio.gain_db {} is too loud (together at most {} "
        "dB FS: turn the amplifier up instead)",
        masking.level_db_fs, audio.gain_db, core::max_noise_level_db_fs)};
  }
  if (masking.kind == core::NoiseKind::band && masking.high_hz > max_edge_of_rate * audio.rate_hz) {
    throw core::InvalidInput{
        fmt::format("masking.band_hz reaches {} Hz, beyond what the rig's audio.rate_hz {} plays "
                    "(at most {:.0f} Hz)",
                    masking.high_hz, audio.rate_hz, max_edge_of_rate * audio.rate_hz)};
  }
}

std::unique_ptr<device::PcmSink> open_masking_card(const protocols::Protocol& protocol,
                                                   const protocols::Rig& rig) {
  if (!protocol.masking) {
    return nullptr;
  }
  if (!has_card(rig)) {
    if (protocol.masking->is_required && kind_of(rig).has_participant()) {
      throw device::DeviceError{
          "the protocol requires masking noise: the rig has neither hardware nor a section "
          "'audio'"};
    }
    warn("masking noise is not played: the rig has neither hardware nor a section 'audio'");
    return nullptr;
  }
  const core::AudioOutput audio = output_of(rig);
  try {
    return device::open_alsa({.card = audio.card, .rate_hz = audio.rate_hz});
  } catch (const device::DeviceError& error) {
    if (protocol.masking->is_required) {
      throw device::DeviceError{
          fmt::format("{} (the protocol requires masking noise)", error.what())};
    }
    warn(fmt::format("masking noise is not played: {}", error.what()));
    return nullptr;
  }
}

core::MaskingNoise played_noise(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  core::MaskingNoise noise = protocol.masking.value_or(core::MaskingNoise{});
  noise.level_db_fs += output_of(rig).gain_db;
  return noise;
}

std::unique_ptr<device::AudioPlayer> masking_player(std::unique_ptr<device::PcmSink> card,
                                                    const protocols::Protocol& protocol,
                                                    const protocols::Rig& rig,
                                                    std::uint64_t session_seed) {
  if (!card) {
    return nullptr;
  }
  const core::MaskingNoise played = played_noise(protocol, rig);
  auto noise = std::make_unique<device::Noise>(
      played, card->rate_hz(), core::derived_seed(session_seed, core::Purpose::masking));
  return std::make_unique<device::AudioPlayer>(std::move(card), std::move(noise), played.ramp_s,
                                               device::below(rig.realtime));
}
}  // namespace tapstudy::runner
