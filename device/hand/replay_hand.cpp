#include "device/hand/replay_hand.hpp"

#include <utility>
namespace tapstudy::device {
ReplayHand::ReplayHand(std::vector<core::HandState> states, std::string source)
    : states_{std::move(states)}, source_{std::move(source)} {}

core::TickFault ReplayHand::read(core::HandState& hand, double /*elapsed_s*/) noexcept {
  const bool has_ended = next_ >= states_.size();
  hand = has_ended ? core::HandState{states_.back().position_m} : states_[next_];
  next_ += has_ended ? 0 : 1;
  return core::TickFault::none;
}

core::TickFault ReplayHand::write(const core::Vec3& /*force_n*/) noexcept {
  return core::TickFault::none;
}
}  // namespace tapstudy::device
