#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tick/actuator_voice.hpp"
#include "core/tick/spsc_ring.hpp"
namespace tapstudy::device {
// Renders the actuator's samples from what the haptic loop tells of its ticks, each a fixed delay
// after its time. Everything but `ticks` is the audio thread's.
//
// The ticks cease when the loop has stalled, faulted or ended: two of its periods, and 2 ms,
// without one end what is heard within a period of samples. Of a loop that has ended in order, all
// ticks are heard. Where one waveform ends and another begins, or none, the difference fades over a
// millisecond.
class ActuatorSource {
 public:
  struct Settings {
    double rate_hz{};
    double full_scale_n{};
    core::ActuatorLimits limits;
    double tick_s{};   // of the haptic loop
    double delay_s{};  // from a tick to its sound
  };
  // What is left of the samples before a trial, and acts on its own.
  struct Before {
    double last_n{};          // the latest sample, before the limiter
    double mean_square_n2{};  // of ActuatorLimiter
  };
  explicit ActuatorSource(const Settings& settings) : ActuatorSource{settings, Before{}} {}
  ActuatorSource(const Settings& settings, const Before& before);
  Before before() const noexcept { return {last_n_, limiter_.mean_square_n2()}; }

  // Of the haptic loop.
  core::SpscRing<core::ActuatorTick>& ticks() noexcept { return ticks_; }
  // The alternatives of the next trial; empty: silence. They must outlive it.
  void use(std::span<core::ActuatorVoice> voices) noexcept;
  // The next samples, of which the first is heard then and the others one after the other; it is
  // now `now_ns`. All by the loop's clock.
  void fill(std::span<float> samples, std::int64_t heard_at_ns, double frame_ns,
            std::int64_t now_ns) noexcept;
  // Takes what the loop has told; whether nothing of it is still to be heard.
  bool is_done() noexcept;
  // Ticks of the loop that it has taken since use(), and such as did not get here.
  std::uint32_t ticks_taken() const noexcept { return taken_; }
  std::int64_t ticks_lost() const noexcept;
  std::int64_t limited() const noexcept { return limited_; }  // samples, since use()

 private:
  void take_ticks() noexcept;
  const core::ActuatorTick* due(std::int64_t heard_at_ns, double since_ns) noexcept;
  void begin(const core::ActuatorTick& tick) noexcept;
  double next_force_n(std::int64_t heard_at_ns, double since_ns) noexcept;
  void bridge_gap() noexcept;

  Settings settings_;
  std::int64_t delay_ns_;
  core::SpscRing<core::ActuatorTick> ticks_;
  std::vector<core::ActuatorTick> waiting_;  // a ring: taken, and not yet due
  std::size_t first_{0};
  std::size_t count_{0};
  std::int64_t newest_ns_{0};
  std::uint32_t taken_{0};
  std::size_t lost_before_{0};  // ticks, until use()
  bool is_newest_last_{false};
  int end_left_{0};  // samples until what the last tick ended is silent
  std::span<core::ActuatorVoice> voices_;
  core::ActuatorVoice* heard_{nullptr};
  bool has_faded_{false};
  int samples_a_tick_;
  double last_n_;          // the latest sample, before the limiter
  double bridged_n_{0.0};  // what is left of a waveform that has ended
  double bridge_step_n_{0.0};
  int bridge_left_{0};
  core::ActuatorLimiter limiter_;
  std::int64_t limited_{0};
};
}  // namespace tapstudy::device
