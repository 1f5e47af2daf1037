#pragma once
#include <array>

#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
// Counts the periods of the loop that were missed within the last second, to 1/20 of a second.
// Somebody who feels the plate would not notice one of them; many mean that the device replies too
// late or that the machine is busy, and that the force is not the one that the study describes.
class MissedPeriods {
 public:
  void add(Nanoseconds now, Nanoseconds missed) noexcept {
    const Nanoseconds slot = now / slot_length;
    for (; last_slot_ < slot && sum_ > 0; ++last_slot_) {
      Nanoseconds& oldest = in_slot_[place(last_slot_ + 1)];
      sum_ -= oldest;
      oldest = 0;
    }
    last_slot_ = slot;
    in_slot_[place(slot)] += missed;
    sum_ += missed;
  }
  Nanoseconds within_a_second() const noexcept { return sum_; }

 private:
  static constexpr std::size_t slots = 20;
  static constexpr Nanoseconds slot_length = 1'000'000'000 / slots;
  static std::size_t place(Nanoseconds slot) noexcept {
    return static_cast<std::size_t>(slot) % slots;
  }
  std::array<Nanoseconds, slots> in_slot_{};
  Nanoseconds last_slot_{0};
  Nanoseconds sum_{0};
};
}  // namespace tapstudy::device
