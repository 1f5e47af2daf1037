#include "device/hand/simulated_hand.hpp"

#include "support/catch.hpp"
using namespace tapstudy;
using core::Vec3;
using device::PlannedTap;
using Memory = device::SimulatedHand::Memory;

namespace {
constexpr double dt_s = 1e-3;
core::HandState state_of(device::SimulatedHand& hand) {
  core::HandState state;
  CHECK(hand.read(state, 1e-3) == core::TickFault::none);
  return state;
}
void push(device::SimulatedHand& hand, const Vec3& force_n) {
  CHECK(hand.write(force_n) == core::TickFault::none);
}
}  // namespace

TEST_CASE("a tap without run-up arrives at exactly the speed asked for", "[device][hand]") {
  device::SimulatedHand hand{{}, dt_s, Memory::none};
  PlannedTap tap;
  tap.speed_m_s = GENERATE(0.05, 0.3, 1.0);
  tap.run_up_m = 0.0;
  hand.follow({tap});
  while (state_of(hand).position_m.y() > 0.0) {
    CHECK(state_of(hand).velocity_m_s.y() == Approx(-tap.speed_m_s));
    push(hand, Vec3::Zero());
  }
}

TEST_CASE("a held hand leans on its muscle: displacement is force over stiffness",
          "[device][hand]") {
  const core::HandBody body{
      .mass_kg = 0.1, .muscle_stiffness_n_per_m = 400.0, .muscle_damping_n_s_per_m = 9.0};
  device::SimulatedHand hand{body, dt_s, Memory::none};
  PlannedTap still;
  still.run_up_m = 0.0;
  still.press_m = 0.0;
  still.dwell_s = 10.0;
  hand.follow({still});
  for (int tick = 0; tick < 3000; ++tick) {
    push(hand, Vec3{0.0, 2.0, 0.0});
  }
  CHECK(state_of(hand).position_m.y() == Approx(2.0 / 400.0));
  CHECK(state_of(hand).velocity_m_s.norm() < 1e-9);
}

TEST_CASE("the hand's motion does not depend on how finely it is stepped", "[device][hand]") {
  device::SimulatedHand coarse{{}, 1e-3, Memory::none};
  device::SimulatedHand fine{{}, 1e-4, Memory::none};
  PlannedTap tap;
  tap.run_up_m = 0.0;
  coarse.follow({tap});
  fine.follow({tap});
  for (int tick = 0; tick < 50; ++tick) {
    const Vec3 force{0.0, tick < 20 ? 1.0 : 0.0, 0.0};
    push(coarse, force);
    for (int i = 0; i < 10; ++i) {
      push(fine, force);
    }
  }
  CHECK((state_of(coarse).position_m - state_of(fine).position_m).norm() < 1e-9);
}

TEST_CASE("a path is continuous and taps where it should", "[device][hand]") {
  PlannedTap first;
  PlannedTap second;
  second.point_m = {0.03, 0.0, -0.01};
  const device::TapPath path{{first, second}, Vec3{0.01, 0.05, 0.0}};
  device::Target before = path.at(0.0);
  CHECK(before.position_m == Vec3{0.01, 0.05, 0.0});
  double lowest = 1.0;
  for (double t = dt_s; t < path.duration_s(); t += dt_s) {
    const device::Target now = path.at(t);
    CHECK((now.position_m - before.position_m).norm() < 1e-3);
    lowest = std::min(lowest, now.position_m.y());
    before = now;
  }
  CHECK(lowest == Approx(-first.press_m));
  CHECK((before.position_m - Vec3{0.03, second.hover_m, -0.01}).norm() < 1e-4);
}

TEST_CASE("a hand remembers all that it felt, if it is to remember", "[device][hand]") {
  const auto memory = GENERATE(Memory::kept, Memory::none);
  device::SimulatedHand hand{{}, dt_s, memory};
  const int ticks = static_cast<int>(hand.follow({PlannedTap{}}) / dt_s);
  for (int tick = 0; tick < ticks; ++tick) {
    push(hand, Vec3{0.0, 1e-3 * tick, 0.0});
  }
  CHECK(hand.felt().size() == (memory == Memory::kept ? static_cast<std::size_t>(ticks) : 0));
  hand.forget();
  CHECK(hand.felt().empty());
}
