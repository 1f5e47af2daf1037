#include "device/hand/simulated_hand.hpp"

#include <cmath>
namespace tapstudy::device {
SimulatedHand::SimulatedHand(const core::HandBody& body, double dt_s, Memory memory)
    : body_{body, dt_s}, dt_s_{dt_s}, memory_{memory} {}

double SimulatedHand::follow(std::vector<PlannedTap> taps) {
  TapPath path{std::move(taps),
               has_started_ ? std::optional{body_.state().position_m} : std::nullopt};
  const double duration_s = path.duration_s();
  start(std::move(path), duration_s);
  return duration_s;
}

void SimulatedHand::hold(double seconds) {
  start(TapPath{{}, has_started_ ? std::optional{body_.state().position_m} : std::nullopt},
        seconds);
}

void SimulatedHand::start(TapPath path, double duration_s) {
  path_ = std::move(path);
  ticks_ = 0;
  const Target start = path_.at(0.0);
  aim_m_ = start.position_m;
  if (!has_started_) {
    body_.place({start.position_m, start.velocity_m_s});
    has_started_ = true;
  }
  if (memory_ == Memory::kept) {
    felt_.reserve(felt_.size() + static_cast<std::size_t>(std::ceil(duration_s / dt_s_)));
  }
}

core::TickFault SimulatedHand::read(core::HandState& hand, double /*elapsed_s*/) noexcept {
  hand = body_.state();
  return core::TickFault::none;
}

core::TickFault SimulatedHand::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  if (memory_ == Memory::kept && felt_.size() < felt_.capacity()) {
    felt_.push_back({body_.state(), force_n});
  }
  const core::Vec3 next_aim_m = path_.at(static_cast<double>(++ticks_) * dt_s_).position_m;
  body_.move(aim_m_, next_aim_m, force_n);
  aim_m_ = next_aim_m;
  return core::TickFault::none;
}
}  // namespace tapstudy::device
