#pragma once
#include "device/loop/haptic_loop.hpp"
#include "runner/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// What an exploration asks of the haptic loop, whatever its clock.
class LoopExploration : public Exploration {
 public:
  // The loop must outlive it.
  explicit LoopExploration(device::HapticLoop& loop) : loop_{loop} {}
  void switch_to(std::size_t alternative) override {
    current_ = alternative;
    loop_.request_alternative(alternative);
  }
  std::size_t current() const override { return current_; }
  void silence(bool is_silent) override { loop_.request_silence(is_silent); }
  bool is_as_asked() const override { return loop_.is_as_requested(); }
  int contacts(std::size_t alternative) const override { return loop_.contacts(alternative); }

 protected:
  device::HapticLoop& loop() const { return loop_; }

 private:
  device::HapticLoop& loop_;
  std::size_t current_{0};
};
}  // namespace tapstudy::runner
