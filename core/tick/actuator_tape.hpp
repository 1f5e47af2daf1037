#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "core/tick/spsc_ring.hpp"
namespace tapstudy::core {
// A period of the samples that an actuator's card is given, with what they are rendered from beside
// the ticks of the loop; times by the loop's clock.
struct ActuatorPeriod {
  std::int64_t heard_at_ns{};   // its first sample
  double frame_ns{};            // from one sample to the next
  std::int64_t filled_at_ns{};  // when it was rendered
  std::uint32_t ticks{};        // of the trial, that the loop had told by then
  std::uint16_t samples{};
  bool follows_gap{};  // the card had run empty
  bool is_heard{};     // it reached the card
};
static_assert(std::is_trivially_copyable_v<ActuatorPeriod>);

// From the audio thread to the recorder: a trial's periods, from the first one on without a gap.
// What does not fit is dropped and counted, with all that comes after it in the trial.
class ActuatorTape {
 public:
  ActuatorTape(std::size_t periods, std::size_t samples) : periods_{periods}, samples_{samples} {}
  // Of a trial, before either thread uses it.
  void begin() {
    ActuatorPeriod period{};
    std::vector<float> discarded;
    while (pop(period, discarded)) {
    }
    dropped_.store(0, std::memory_order_relaxed);
  }
  // The audio thread's. At most as many samples as fit into the period's count.
  void push(ActuatorPeriod period, std::span<const float> samples) noexcept {
    if (dropped() > 0 || periods_.free() == 0 || samples_.free() < samples.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    for (const float sample : samples) {
      samples_.try_push(sample);
    }
    period.samples = static_cast<std::uint16_t>(samples.size());
    periods_.try_push(period);
  }
  // The recorder's: the next period, and its samples at the end of these.
  bool pop(ActuatorPeriod& period, std::vector<float>& samples) {
    if (!periods_.try_pop(period)) {
      return false;
    }
    float sample = 0.0F;
    for (int i = 0; i < period.samples && samples_.try_pop(sample); ++i) {
      samples.push_back(sample);
    }
    return true;
  }
  std::int64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  SpscRing<ActuatorPeriod> periods_;
  SpscRing<float> samples_;
  std::atomic<std::int64_t> dropped_{0};  // periods
};
}  // namespace tapstudy::core
