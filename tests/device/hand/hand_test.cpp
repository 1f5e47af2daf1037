#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "device/hand/penalty_limit.hpp"
#include "device/hand/scripted_hand.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/staged_loop.hpp"
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

namespace {
const core::HandBody body;
constexpr double tick_s = 1e-3;

// Held by a hand that moves as it likes.
class HeldDevice final : public device::Device {
 public:
  explicit HeldDevice(double sway_m) : sway_m_{sway_m} {}
  core::TickFault read(core::HandState& hand, double /*elapsed_s*/) noexcept override {
    hand.position_m = {sway_m_ * std::sin(0.01 * reads_++), sway_m_, 0.0};
    hand.velocity_m_s = Vec3::Zero();
    return core::TickFault::none;
  }
  core::TickFault write(const Vec3& force_n) noexcept override {
    written_n.push_back(force_n.y());
    return core::TickFault::none;
  }
  device::DeviceDetail detail() const noexcept override { return {}; }
  std::string description() const override { return "held"; }
  std::vector<double> written_n;

 private:
  double sway_m_;
  int reads_{0};
};

std::vector<core::TapRenderer> two_springs() {
  std::vector<core::TapRenderer> springs;
  for (int i = 0; i < 2; ++i) {
    springs.emplace_back(core::RenderSettings{}, core::PlateFace{0.3, 0.3},
                         std::vector<std::unique_ptr<core::AddedForce>>{});
  }
  return springs;
}

device::LoopSettings strong() {
  device::LoopSettings settings;
  settings.gate.limits = {20.0, 1e6};
  return settings;
}

struct Bench {
  explicit Bench(double sway_m) : held{sway_m} { held.written_n.reserve(20'000); }
  std::vector<core::TraceSample> samples() { return testing::samples_of(trace); }
  HeldDevice held;
  device::VirtualClock clock;
  std::vector<core::TapRenderer> renderers{two_springs()};
  device::LoopSettings settings{strong()};
  core::SpscRing<core::TraceSample> trace{1U << 15U};
  device::ScriptedHand taps{{body, {0.1, 0.0, 0.0}, 0.3, 0.2, 0.3}, {}, tick_s};
  device::HapticLoop loop{held, renderers, settings, trace, clock, &taps};
};

std::vector<std::size_t> impacts(const std::vector<core::TraceSample>& samples) {
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].impact) {
      ticks.push_back(i);
    }
  }
  return ticks;
}
}  // namespace

TEST_CASE("scripted taps are all alike, at the stated speed and as often as stated",
          "[device][scripted]") {
  Bench bench{0.0};
  const device::RepeatedTap tap{body, {0.1, 0.0, 0.0}, 0.3, 0.2, 0.3};
  const auto period = static_cast<std::size_t>(std::ceil(tap.duration_s() / tick_s));
  bench.loop.run_ticks(static_cast<std::int64_t>(5 * period));
  const auto samples = bench.samples();
  const auto at = impacts(samples);
  REQUIRE(at.size() >= 5);  // a hand may bounce
  for (std::size_t tick = 0; tick < period; ++tick) {
    for (std::size_t k = 1; k < 5; ++k) {
      REQUIRE(samples[tick + k * period].penalty_n == samples[tick].penalty_n);
      REQUIRE(samples[tick + k * period].position_m == samples[tick].position_m);
    }
  }
  CHECK(-samples[at.front()].velocity_m_s[1] == Approx(0.3).epsilon(0.02));
}

TEST_CASE("what the held hand does changes neither a scripted tap nor the force that it feels",
          "[device][scripted]") {
  Bench still{0.0};
  Bench swaying{0.02};
  still.loop.run_ticks(2000);
  swaying.loop.run_ticks(2000);
  CHECK(still.held.written_n == swaying.held.written_n);
  const auto felt = still.samples();
  REQUIRE(impacts(felt).size() >= 2);
  for (std::size_t i = 0; i < felt.size(); ++i) {
    REQUIRE(still.held.written_n[i] == felt[i].force_n[1]);
    REQUIRE(felt[i].force_n[1] == Approx(felt[i].penalty_n));
  }
}

TEST_CASE("after a switch and after silence the first scripted tap comes as soon as at the begin",
          "[device][scripted]") {
  Bench bench{0.0};
  bench.loop.run_ticks(1000);
  const std::size_t first = impacts(bench.samples()).front();
  bench.loop.request_alternative(1);
  bench.loop.run_ticks(1000);
  const auto switched = bench.samples();
  const auto by_second = std::ranges::find(switched, 1, &core::TraceSample::alternative);
  REQUIRE(by_second != switched.end());
  const auto taken = static_cast<std::size_t>(by_second - switched.begin());
  CHECK(impacts({by_second, switched.end()}).front() == first);
  CHECK(taken < 1000);
  bench.loop.request_silence(true);
  bench.loop.run_ticks(1000);
  bench.samples();
  bench.loop.request_silence(false);
  bench.loop.run_ticks(1000);
  // it may have been asked for in contact, which nobody felt
  const auto again = impacts(bench.samples());
  REQUIRE_FALSE(again.empty());
  CHECK(again.front() >= first);
  CHECK(again.front() < first + 300);
}

TEST_CASE("a hand that leaves the workspace ends scripted taps as it ends its own",
          "[device][scripted][safety]") {
  Bench bench{0.02};
  bench.settings.gate.workspace_radius_m = 0.01;
  device::ScriptedHand taps{{body, Vec3::Zero(), 0.3, 0.2, 0.3}, {}, tick_s};
  device::HapticLoop loop{bench.held,  bench.renderers, bench.settings,
                          bench.trace, bench.clock,     &taps};
  loop.run_ticks(10);
  CHECK(loop.report().stopped_by == core::TickFault::outside_workspace);
  CHECK(bench.held.written_n.back() == 0.0);
}

TEST_CASE("a tick of scripted taps allocates nothing", "[device][scripted]") {
  Bench bench{0.0};
  const testing::AllocationCount allocations;
  bench.loop.run_ticks(2000);
  CHECK(allocations.count() == 0);
}

namespace {
// The hand against a wall that is sampled, held, and answered so many ticks later, by the matrix
// exponential of (position, velocity, held force).
double spectral_radius(const core::HandBody& hand, double penalty_n_per_m, double dt_s, int delay) {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();
  rate(0, 1) = 1.0;
  rate.row(1) << -hand.muscle_stiffness_n_per_m / hand.mass_kg,
      -hand.muscle_damping_n_s_per_m / hand.mass_kg, 1.0 / hand.mass_kg;
  const Eigen::Matrix3d held = (rate * dt_s).exp();
  Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(2 + delay, 2 + delay);
  loop.topLeftCorner<2, 2>() = held.topLeftCorner<2, 2>();
  for (int i = 0; i < delay; ++i) {
    loop(2 + i, i == 0 ? 0 : 1 + i) = 1.0;
  }
  loop.topRows<2>().col(delay == 0 ? 0 : 1 + delay) -=
      penalty_n_per_m * held.topRightCorner<2, 1>();
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}
}  // namespace

TEST_CASE("at the largest stable penalty the sampled loop neither grows nor dies",
          "[device][stability]") {
  const double mass = GENERATE(0.02, 0.1, 1.0);
  const double stiffness = GENERATE(10.0, 400.0, 5000.0);
  const double damping = GENERATE(0.5, 9.0, 60.0);
  const double rate_hz = GENERATE(500.0, 1000.0, 10000.0);
  const core::HandBody hand{mass, stiffness, damping};
  const int delay = GENERATE(0, 1, 3);
  const double limit = device::largest_stable_penalty_n_per_m(hand, 1.0 / rate_hz, delay);
  CAPTURE(mass, stiffness, damping, rate_hz, delay, limit);
  CHECK(spectral_radius(hand, limit, 1.0 / rate_hz, delay) == Approx(1.0).margin(1e-9));
  CHECK(spectral_radius(hand, 0.99 * limit, 1.0 / rate_hz, delay) < 1.0);
  CHECK(spectral_radius(hand, 1.01 * limit, 1.0 / rate_hz, delay) > 1.0);
}

TEST_CASE("for short ticks the largest stable penalty is 2 b / dt", "[device][stability]") {
  const double dt_s = 1e-6;
  const core::HandBody hand;
  CHECK(device::largest_stable_penalty_n_per_m(hand, dt_s) ==
        Approx(2.0 * hand.muscle_damping_n_s_per_m / dt_s).epsilon(1e-3));
}

TEST_CASE("with a delay, the largest stable penalty tends to b / (dt / 2 + delay)",
          "[device][stability]") {
  const double dt_s = 1e-6;
  const core::HandBody hand;
  CHECK(device::largest_stable_penalty_n_per_m(hand, dt_s, 1) ==
        Approx(hand.muscle_damping_n_s_per_m / (1.5 * dt_s)).epsilon(1e-3));
}
