#include "device/loop/force_gate.hpp"

#include <cmath>
#include <limits>

#include "core/random/rng.hpp"
#include "device/spidar/string_support.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using core::GateSettings;
using core::TickFault;
using core::Vec3;
using device::ForceGate;

namespace {
GateSettings for_hardware() {
  GateSettings settings;
  settings.limits = {5.0, 2000.0};
  settings.max_hand_speed_m_s = 1.0;
  settings.workspace_radius_m = 0.02;
  settings.force_rise_s = 0.5;
  settings.force_fall_s = 0.1;
  return settings;
}
const core::HandState still{};
constexpr double dt_s = 1e-3;

void let_on(ForceGate& gate, int ticks = 600) {
  for (int i = 0; i < ticks; ++i) {
    gate.pass(Vec3::Zero(), still, dt_s);
  }
}
}  // namespace

TEST_CASE("a finger that rests inside a plate is not thrown out", "[device][safety]") {
  ForceGate gate{for_hardware(), dt_s};
  for (int i = 0; i < 1000; ++i) {
    CHECK(gate.pass({0, 3, 0}, still, dt_s).force_n == Vec3::Zero());
  }
  CHECK(gate.state() == ForceGate::State::armed);
  let_on(gate, 20);
  CHECK(gate.state() == ForceGate::State::rendering);
}

TEST_CASE("a gate opens after 10 ms without a noticeable force, at any rate", "[device][safety]") {
  const int rate_hz = GENERATE(500, 1000, 8000);
  ForceGate gate{for_hardware(), 1.0 / rate_hz};
  let_on(gate, rate_hz / 100 - 1);
  CHECK(gate.state() == ForceGate::State::armed);
  let_on(gate, 1);
  CHECK(gate.state() == ForceGate::State::rendering);
}

TEST_CASE("force rises evenly once it is let on, and falls evenly when it is taken off",
          "[device][safety]") {
  ForceGate gate{for_hardware(), dt_s};
  let_on(gate, 10);
  double before = 0.0;
  for (int i = 1; i <= 500; ++i) {
    const double now = gate.pass({0, 2, 0}, still, dt_s).force_n.y();
    CHECK(now - before == Approx(2.0 / 500).margin(1e-9));
    before = now;
  }
  CHECK(before == Approx(2.0));
  gate.stop();
  int ticks = 0;
  while (gate.state() != ForceGate::State::at_rest && ticks++ < 1000) {
    gate.pass({0, 2, 0}, still, dt_s);
  }
  CHECK(ticks == Approx(100).margin(2));
  CHECK(gate.pass({0, 2, 0}, still, dt_s).force_n == Vec3::Zero());
}

TEST_CASE("whatever is asked, what comes out is finite, bounded in size and in rate",
          "[device][safety]") {
  const GateSettings settings = for_hardware();
  ForceGate gate{settings, dt_s};
  let_on(gate);
  core::Rng rng{1};
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 100000; ++i) {
    const double size = std::pow(10.0, 10.0 * rng.uniform() - 5.0);
    const Vec3 wanted =
        i % 1000 == 999
            ? Vec3::Constant(rng.below(2) == 1 ? std::numeric_limits<double>::quiet_NaN()
                                               : std::numeric_limits<double>::infinity())
            : testing::random_vector(rng, size);
    const auto passed = gate.pass(wanted, still, dt_s);
    REQUIRE(passed.force_n.allFinite());
    CHECK(passed.force_n.norm() <= 5.0 + 1e-9);
    const bool is_fault = passed.fault != TickFault::none;
    CHECK(is_fault == !wanted.allFinite());
    CHECK((is_fault || (passed.force_n - before).norm() <= 2.0 + 1e-9));
    before = passed.force_n;
  }
}

TEST_CASE("a hand too fast, outside or nowhere is a fault and no force", "[device][safety]") {
  ForceGate gate{for_hardware(), dt_s};
  let_on(gate);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    core::HandState hand;
    TickFault fault;
  };
  const auto one = GENERATE_COPY(Case{{{0, 0, 0}, {0, -1.1, 0}}, TickFault::too_fast},
                                 Case{{{0.021, 0, 0}, {0, 0, 0}}, TickFault::outside_workspace},
                                 Case{{{nan, 0, 0}, {0, 0, 0}}, TickFault::non_finite_force},
                                 Case{{{0, 0, 0}, {0, nan, 0}}, TickFault::non_finite_force});
  const auto passed = gate.pass({0, 1, 0}, one.hand, dt_s);
  CHECK(passed.fault == one.fault);
  CHECK(passed.force_n == Vec3::Zero());
}

TEST_CASE("without a rise the gate is open at once and changes nothing within its limits",
          "[device][safety]") {
  GateSettings settings;
  settings.limits = {10.0, 1e5};
  ForceGate gate{settings, dt_s};
  const Vec3 wanted{0.123456789, 1.0 / 3.0, -2.0};
  const auto passed = gate.pass(wanted, still, dt_s);
  CHECK(passed.force_n == wanted);
  CHECK(!passed.was_changed);
}

TEST_CASE("a position that jumps is a hand too fast, whatever velocity the device tells",
          "[device][safety]") {
  ForceGate gate{for_hardware(), dt_s};
  let_on(gate);
  core::HandState hand;
  hand.position_m = {0.0, -0.0019, 0.0};
  CHECK(gate.pass({0, 1, 0}, hand, dt_s).fault == TickFault::none);
  hand.position_m = {0.0, 0.0021, 0.0};
  CHECK(gate.pass({0, 1, 0}, hand, 2.0 * dt_s).fault == TickFault::none);  // a tick was skipped
  hand.position_m = {0.0, -0.0021, 0.0};
  const auto passed = gate.pass({0, 1, 0}, hand, dt_s);
  CHECK(passed.fault == TickFault::too_fast);
  CHECK(passed.force_n == Vec3::Zero());
}
