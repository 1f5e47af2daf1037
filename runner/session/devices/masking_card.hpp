#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "device/audio/audio_player.hpp"
#include "protocols/protocol.hpp"
#include "protocols/rig.hpp"
namespace tapstudy::runner {
// What a protocol plays, on one line.
std::string described(const core::MaskingNoise& masking);

// Throws InvalidInput if the rig's card cannot play what the protocol asks for: too loud with the
// rig's gain, or a band beyond half the card's rate.
void check_masking(const protocols::Protocol& protocol, const protocols::Rig& rig);

// The rig's card, or ALSA's default beside hardware; null if the session plays no noise. Where the
// card is missing, throws DeviceError if the protocol requires the noise, else warns.
std::unique_ptr<device::PcmSink> open_masking_card(const protocols::Protocol& protocol,
                                                   const protocols::Rig& rig);

// The protocol's noise at the level that is played, the rig's gain included.
core::MaskingNoise played_noise(const protocols::Protocol& protocol, const protocols::Rig& rig);
// Plays it; null without a card.
std::unique_ptr<device::AudioPlayer> masking_player(std::unique_ptr<device::PcmSink> card,
                                                    const protocols::Protocol& protocol,
                                                    const protocols::Rig& rig,
                                                    std::uint64_t session_seed);
}  // namespace tapstudy::runner
