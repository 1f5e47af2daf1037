#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/settings/device_settings.hpp"
#include "device/audio/pcm.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
// How punctually a thread keeps a card's buffer full.
struct ProbedCard {
  double rate_hz{};
  double period_s{};
  double buffer_s{};
  double delay_s{};  // actuator_delay_s
  // Of each period: for how long the card had had room for it. Without those that fill the buffer;
  // empty where the card does not tell what it has played.
  LatenessCount lateness{};
  std::int64_t gaps{};
  double rate_error{};               // of the card, against the loop's clock
  std::optional<double> jitter_s{};  // as SampleClock
  std::optional<AudioLoss> loss{};
  // A period that is later than this comes after a gap.
  Nanoseconds bridged() const;
};

struct CardTime {
  std::function<std::int64_t()> now_ns;
  std::function<void(std::size_t frames)> wait_after;  // for a card that keeps no time
};

// Plays silence on the card for so many seconds of its samples.
ProbedCard probe_card(PcmSink& sink, double seconds, const CardTime& time);
// The same in real time, on a thread of its own that requests what an actuator's does.
ProbedCard probe_card(PcmSink& sink, double seconds, const core::RealtimeRequest& request);
}  // namespace tapstudy::device
