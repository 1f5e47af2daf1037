#include "device/hand/prescribed_hand.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::device {
AimedHand::AimedHand(const core::HandBody& body, double dt_s, std::vector<core::Vec3> aims_m)
    : body_{body, dt_s}, aims_m_{std::move(aims_m)} {
  body_.place({aims_m_.front(), core::Vec3::Zero()});
}

core::TickFault AimedHand::read(core::HandState& hand, double /*elapsed_s*/) noexcept {
  hand = body_.state();
  return core::TickFault::none;
}

core::TickFault AimedHand::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  const std::size_t next = std::min(tick_ + 1, aims_m_.size() - 1);
  body_.move(aims_m_[tick_], aims_m_[next], force_n);
  tick_ = next;
  return core::TickFault::none;
}

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
