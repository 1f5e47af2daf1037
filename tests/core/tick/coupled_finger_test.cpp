// A finger in contact with a vibrating surface: its equations, and SciPy's Radau solution of them.
#include "core/tick/coupled_finger.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/random/rng.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/god_object.hpp"
#include "core/tick/plate_vibration.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/plates.hpp"
#include "support/processes.hpp"
using namespace tapstudy::core;
namespace testing = tapstudy::testing;

namespace {
double between(Rng& rng, double low, double high) {
  return low * std::pow(high / low, rng.uniform());  // evenly over the decades
}
double stored_j(double stiffness, double compression) {
  return 0.5 * stiffness * std::pow(std::max(0.0, compression), 2);
}
RenderSettings settings_at(double rate_hz) {
  RenderSettings settings;
  settings.dt_s = 1.0 / rate_hz;
  settings.finger.mass_kg = 0.0058;
  return settings;
}
}  // namespace

TEST_CASE("a held force gives an oscillator no more energy than its work", "[core][coupled]") {
  const auto integrator = GENERATE(Integrator::exact, Integrator::newmark);
  Rng rng{5};
  for (int i = 0; i < 20'000; ++i) {
    const double dt_s = between(rng, 1e-4, 2e-3);
    const double omega = between(rng, 1.0, 1e5);
    const double zeta = between(rng, 1e-4, 100.0);
    const StateTransition step = state_transition(integrator, omega, zeta, dt_s);
    const HeldForceResponse held = held_force_response(integrator, omega, zeta, dt_s);
    const double q = rng.normal() / omega;
    const double v = rng.normal();
    const double force = omega * rng.normal();
    const double q_after = step.qq * q + step.qv * v + held.q * force;
    const double v_after = step.vq * q + step.vv * v + held.v * force;
    const double before_j = 0.5 * (v * v + omega * omega * q * q);
    const double after_j = 0.5 * (v_after * v_after + omega * omega * q_after * q_after);
    const double scale_j = before_j + after_j + std::pow(force / omega, 2);
    CHECK(after_j - before_j <= force * (q_after - q) + 1e-12 * scale_j);
  }
}

TEST_CASE("a tick under a held force is as many shorter ticks under it", "[core][coupled]") {
  for (const double zeta : {0.0, 0.02, 1.0, 30.0}) {
    const double omega = 700.0;
    const HeldForceResponse whole = held_force_response(Integrator::exact, omega, zeta, 1e-3);
    const StateTransition part = exact_transition(omega, zeta, 1e-5);
    const HeldForceResponse held = held_force_response(Integrator::exact, omega, zeta, 1e-5);
    double q = 0.0;
    double v = 0.0;
    for (int i = 0; i < 100; ++i) {
      const double next = part.qq * q + part.qv * v + held.q;
      v = part.vq * q + part.vv * v + held.v;
      q = next;
    }
    CHECK(whole.q == Approx(q).epsilon(1e-8));
    CHECK(whole.v == Approx(v).epsilon(1e-8));
  }
  CHECK(held_force_response(Integrator::exact, 1e-9, 0.0, 1e-3).q == Approx(0.5e-6));
}

TEST_CASE("the contact force is the discrete gradient of its energy and never pulls",
          "[core][coupled]") {
  Rng rng{9};
  for (int i = 0; i < 100'000; ++i) {
    const double stiffness = between(rng, 1e-3, 1e9);
    const double compliance = between(rng, 1e-9, 1.0);
    const double before = between(rng, 1e-9, 1e-2) * (rng.uniform() < 0.5 ? 1.0 : -1.0);
    const double unloaded = between(rng, 1e-9, 1e-2) * (rng.uniform() < 0.5 ? 1.0 : -1.0);
    const double force = held_contact_force_n({before, unloaded, stiffness}, compliance);
    const double after = unloaded - compliance * force;
    const double gained_j = stored_j(stiffness, after) - stored_j(stiffness, before);
    const double scale_j = stored_j(stiffness, after) + stored_j(stiffness, before) +
                           force * (std::abs(after) + std::abs(before) + std::abs(unloaded));
    INFO(before << " " << unloaded << " " << compliance << " " << stiffness);
    REQUIRE(force >= 0.0);
    REQUIRE(std::abs(force * (after - before) - gained_j) <= 1e-9 * scale_j);
  }
}

TEST_CASE("two contacts with one surface are each the discrete gradient of its energy",
          "[core][coupled]") {
  Rng rng{11};
  const auto either_sign = [&] {
    return between(rng, 1e-9, 1e-2) * (rng.uniform() < 0.5 ? 1.0 : -1.0);
  };
  for (int i = 0; i < 100'000; ++i) {
    const ContactTick pad{either_sign(), either_sign(), between(rng, 1e-1, 1e7)};
    const ContactTick support{either_sign(), either_sign(), between(rng, 1e-1, 1e7)};
    const double surface = i % 10 == 0 ? 0.0 : between(rng, 1e-9, 1.0);
    const double finger = between(rng, 1e-9, 1.0);
    const HeldContacts held = held_contacts(pad, support, surface, finger);
    INFO(pad.before_m << " " << pad.unloaded_m << " " << pad.stiffness_n_per_m);
    INFO(support.before_m << " " << support.unloaded_m << " " << support.stiffness_n_per_m);
    INFO(surface << " " << finger);
    const double sunk = surface * (held.pad_n + held.support_n);
    const auto check = [](const ContactTick& contact, double force_n, double after_m) {
      REQUIRE(force_n >= 0.0);
      const double before_j = stored_j(contact.stiffness_n_per_m, contact.before_m);
      const double after_j = stored_j(contact.stiffness_n_per_m, after_m);
      const double scale_j =
          after_j + before_j +
          force_n * (std::abs(after_m) + std::abs(contact.before_m) + std::abs(contact.unloaded_m));
      REQUIRE(std::abs(force_n * (after_m - contact.before_m) - after_j + before_j) <=
              1e-9 * scale_j);
    };
    check(pad, held.pad_n, pad.unloaded_m - sunk - finger * held.pad_n);
    check(support, held.support_n, support.unloaded_m - sunk);
  }
}

TEST_CASE("an elastic finger that no hand holds gives a wall twice its momentum",
          "[core][coupled]") {
  for (const double rate_hz : {500.0, 1000.0, 10'000.0}) {
    const double speed_m_s = 0.3;
    const Finger loose{0.0058, 1e-9, 0.0};
    CoupledFinger finger{loose, {3000.0, 0.0}, 1.0 / rate_hz};
    finger.begin(1e-4, -speed_m_s, 0.0);
    double impulse_n_s = 0.0;
    for (int tick = 0; tick < static_cast<int>(0.02 * rate_hz); ++tick) {
      const double contact_n = finger.tick(0.0, {});
      CHECK(contact_n >= 0.0);
      impulse_n_s += contact_n / rate_hz;
    }
    CHECK(impulse_n_s == Approx(2.0 * loose.mass_kg * speed_m_s).epsilon(1e-6));
  }
}

namespace {
// A tapping hand: it moves towards a new aim again and again, at a speed limited only by the lag.
class WanderingHand {
 public:
  WanderingHand(Rng& rng, double dt_s) : rng_{&rng}, dt_s_{dt_s} {}
  HandState tick() {
    if (rng_->uniform() < 20.0 * dt_s_) {
      aim_m_ = 0.01 * rng_->normal();
    }
    const double before_m = height_m_;
    height_m_ += dt_s_ / (0.005 + dt_s_) * (aim_m_ - height_m_);
    return {{0.0, 0.0, height_m_}, {0.0, 0.0, (height_m_ - before_m) / dt_s_}};
  }

 private:
  Rng* rng_;
  double dt_s_;
  double aim_m_{0.01};
  double height_m_{0.01};
};
}  // namespace

namespace {
// eq. 18: the penalty force and what the finger adds to it
double force_on_hand_n(const CoupledVibration& coupled, const Contact& contact,
                       const RenderSettings& settings) {
  ForceParts parts;
  parts.penalty_n = settings.penalty_stiffness_n_per_m * contact.penetration_m;
  coupled.add_to(parts);
  return parts.total_n();
}
}  // namespace

TEST_CASE("plate, finger and contact never gain more energy than the hand's work",
          "[core][coupled][safety]") {
  const auto integrator = GENERATE(Integrator::exact, Integrator::newmark);
  Rng rng{17};
  int contacts = 0;
  for (const double rate_hz : {500.0, 700.0, 1000.0, 2000.0, 5000.0, 10'000.0}) {
    for (int stage = 0; stage < 20; ++stage) {
      RenderSettings settings = settings_at(rate_hz);
      settings.integrator = integrator;
      settings.penalty_stiffness_n_per_m = between(rng, 10.0, 1e6);
      settings.finger = {between(rng, 1e-7, 1.0), between(rng, 30.0, 30'000.0),
                         between(rng, 1e-3, 100.0)};
      Eigen::ArrayXd frequency_hz(3);
      frequency_hz << between(rng, 5.0, 50.0), between(rng, 50.0, 120.0),
          between(rng, 120.0, 249.0);
      const Eigen::ArrayXd shape =
          Eigen::ArrayXd::NullaryExpr(3, [&] { return 5.0 * rng.normal(); });
      const double zeta = stage % 4 == 0 ? 0.0 : between(rng, 1e-4, 2.0);
      const VibratingPlate plate = testing::uniform_plate(frequency_hz, zeta, shape);
      CoupledVibration coupled{plate, settings};
      PlateContact contact{{0.3, 0.3}, 0.0};
      WanderingHand hand{rng, settings.dt_s};
      double before_j = 0.0;
      double before_m = 0.0;
      bool was_touching = false;
      for (int tick = 0; tick < 2000; ++tick) {
        const Contact& now = contact.tick(hand.tick());
        coupled.advance(1);
        double brought_j = 0.0;
        if (now.touching) {
          coupled.touch(now);
          const double speed = now.normal_velocity_m_s;
          if (!was_touching) {
            ++contacts;
            before_m = std::max(0.0, -now.penetration_m - speed * settings.dt_s);
            brought_j = 0.5 * settings.finger.mass_kg * speed * speed;
          }
          brought_j -= force_on_hand_n(coupled, now, settings) * (-now.penetration_m - before_m);
          before_m = -now.penetration_m;
        }
        const double after_j = coupled.coupled_energy_j();
        REQUIRE(std::isfinite(after_j));
        REQUIRE(after_j - before_j - brought_j <=
                1e-9 * (after_j + before_j + std::abs(brought_j)) + 1e-15);
        was_touching = now.touching;
        before_j = after_j;
      }
    }
  }
  CHECK(contacts > 500);
}

TEST_CASE(
    "at rest a coupled finger is as stiff as the contact spring, and all of its force sags the "
    "surface",
    "[core][coupled]") {
  Rng rng{23};
  for (const double rate_hz : {500.0, 1000.0, 4000.0}) {
    for (int stage = 0; stage < 30; ++stage) {
      RenderSettings settings = settings_at(rate_hz);
      settings.penalty_stiffness_n_per_m = between(rng, 300.0, 30'000.0);
      settings.finger = {between(rng, 1e-3, 0.1), between(rng, 30.0, 30'000.0), 3.0};
      Eigen::ArrayXd frequency_hz(2);
      frequency_hz << between(rng, 3.0, 30.0), between(rng, 30.0, 200.0);
      const Eigen::ArrayXd shape =
          Eigen::ArrayXd::NullaryExpr(2, [&] { return between(rng, 0.1, 3.0); });
      const VibratingPlate plate = testing::uniform_plate(frequency_hz, 0.3, shape);
      CoupledVibration coupled{plate, settings};
      // the surface swings out when the hand comes, and the contact yields to it
      PlateContact contact{{0.3, 0.3}, 0.0};
      const double depth_m = 0.002;
      Contact now;
      for (int tick = 0; tick < static_cast<int>(6.0 * rate_hz); ++tick) {
        const double height_m = std::max(-depth_m, 0.001 - 0.3 * tick / rate_hz);
        now = contact.tick({{0.0, 0.0, height_m}, {0.0, 0.0, height_m > -depth_m ? -0.3 : 0.0}});
        coupled.advance(1);
        if (now.touching) {
          coupled.touch(now);
        }
      }
      const Eigen::ArrayXd omega_rad_s = 2.0 * std::numbers::pi * frequency_hz;
      const double compliance_m_per_n = (shape / omega_rad_s).square().sum();
      const double stiffness_n_per_m = settings.penalty_stiffness_n_per_m;
      const double force_n =
          stiffness_n_per_m * depth_m / (1.0 + stiffness_n_per_m * compliance_m_per_n);
      INFO(stiffness_n_per_m << " " << settings.finger.stiffness_n_per_m);
      CHECK(force_on_hand_n(coupled, now, settings) == Approx(force_n).epsilon(1e-6));
      // the modes' strain energy under that force
      CHECK(coupled.energy_j() ==
            Approx(0.5 * compliance_m_per_n * force_n * force_n).epsilon(1e-5));
    }
  }
}

TEST_CASE("a contact that began inside of a swinging surface is at rest as any other",
          "[core][coupled]") {
  const Finger finger{0.0058, 300.0, 3.0};
  CoupledFinger yielding{finger, contact_stiffness_beside(finger, 3000.0), 1e-3};
  const double swing_m = 2e-4;
  yielding.begin(0.0, -0.1, swing_m);
  double hand_m = 0.0;
  double surface_m = swing_m;
  for (int tick = 0; tick < 2000; ++tick) {
    hand_m = std::max(-0.002, hand_m - 1e-4);
    const double before_m = surface_m;
    surface_m = tick < 10 ? swing_m : 0.0;
    yielding.tick(hand_m, {before_m, surface_m, 0.0});
  }
  CHECK(yielding.force_on_hand_n() == Approx(3000.0 * 0.002).epsilon(1e-9));
}

TEST_CASE("over a surface at rest a finger as soft as can be leaves the penalty force as it is",
          "[core][coupled]") {
  for (const double rate_hz : {500.0, 1000.0, 10'000.0}) {
    Rng rng{29};
    const Finger finger{1e-3, 1e-9, 0.0};
    CoupledFinger soft{finger, contact_stiffness_beside(finger, 3000.0), 1.0 / rate_hz};
    WanderingHand hand{rng, 1.0 / rate_hz};
    soft.begin(hand.tick().position_m.z(), 0.0, 0.0);
    for (int tick = 0; tick < 3000; ++tick) {
      const double hand_m = hand.tick().position_m.z();
      soft.tick(hand_m, {});
      CHECK(soft.force_on_hand_n() == Approx(3000.0 * std::max(0.0, -hand_m)).margin(1e-6));
    }
  }
}

namespace {
struct Mode {
  double frequency_hz;
  double damping_ratio;
  double shape;
};
const std::vector<Mode> three_modes{{60.0, 0.01, 3.0}, {140.0, 0.02, -4.0}, {240.0, 0.03, 5.0}};
constexpr double speed_m_s = 0.3;
constexpr double depth_m = 0.003;
constexpr double window_s = 2e-3;
constexpr int windows = 50;

// The hand goes in at `speed`, and slows down towards `depth`; contact at t = 0.
HandState hand_at(double t_s) {
  if (t_s < 0.0) {
    return {{0.0, 0.0, -speed_m_s * t_s}, {0.0, 0.0, -speed_m_s}};
  }
  const double left = std::exp(-speed_m_s / depth_m * t_s);
  return {{0.0, 0.0, -depth_m * (1.0 - left)}, {0.0, 0.0, -speed_m_s * left}};
}

VibratingPlate plate_of_three_modes() {
  Eigen::ArrayXd frequency_hz(3);
  Eigen::ArrayXd ratio(3);
  Eigen::ArrayXd shape(3);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Mode& mode = three_modes.at(static_cast<std::size_t>(i));
    frequency_hz[i] = mode.frequency_hz;
    ratio[i] = mode.damping_ratio;
    shape[i] = mode.shape;
  }
  return testing::uniform_plate(frequency_hz, ratio, shape);
}

// The impulse of finger on hand in each window, by the technique fem-coupled. Contact begins at
// `phase` of a tick.
Eigen::ArrayXd rendered_impulses(double rate_hz, double phase) {
  const VibratingPlate plate = plate_of_three_modes();
  TapRenderer renderer = make_renderer(*find_technique("fem-coupled"), settings_at(rate_hz),
                                       PlateFace{0.3, 0.3}, &plate);
  const int per_window = static_cast<int>(std::lround(rate_hz * window_s));
  Eigen::ArrayXd impulses = Eigen::ArrayXd::Zero(windows);
  renderer.tick(hand_at((phase - 1.0) / rate_hz));
  for (int tick = 0; tick < windows * per_window; ++tick) {
    const RenderedTick now = renderer.tick(hand_at((tick + phase) / rate_hz));
    impulses[tick / per_window] += now.parts.total_n() / rate_hz;
  }
  return impulses;
}

// The same by SciPy, from the coupled equations of coupled_finger.hpp as they stand there.
Eigen::ArrayXd solved_impulses(double start_s) {
  const Finger finger = settings_at(1000.0).finger;
  const ContactStiffness contact =
      contact_stiffness_beside(finger, settings_at(1000.0).penalty_stiffness_n_per_m);
  std::string modes;
  for (const Mode& mode : three_modes) {
    modes += fmt::format("({:.17g},{:.17g},{:.17g}),", mode.frequency_hz, mode.damping_ratio,
                         mode.shape);
  }
  const std::string script = fmt::format(
      R"(
import numpy as np
from scipy.integrate import solve_ivp
modes = np.array([{}])
omega, zeta, shape = 2 * np.pi * modes[:, 0], modes[:, 1], modes[:, 2]
m, k, b, pad, support = {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}
speed, depth, start, window, windows = {:.17g}, {:.17g}, {:.17g}, {:.17g}, {}
def rates(t, state):
    q, v, y, vy = state[0:3], state[3:6], state[6], state[7]
    left = np.exp(-speed / depth * max(t, 0))
    h = -depth * (1 - left) if t > 0 else -speed * t
    c = pad * max(0.0, shape @ q - y)
    s = support * max(0.0, shape @ q - h)
    f = k * (y - h) + b * (vy + speed * left)
    return np.concatenate([v, -2 * zeta * omega * v - omega**2 * q - shape * (c + s),
                           [vy, (c - f) / m, f + s]])
first = np.zeros(9)
first[6:8] = -speed * start, -speed
solved = solve_ivp(rates, (start, start + windows * window), first, method='Radau', rtol=1e-9,
                   atol=1e-13, max_step=1e-4, t_eval=start + window * np.arange(windows + 1))
for impulse in np.diff(solved.y[8]):
    print('%.17g' % impulse)
)",
      modes, finger.mass_kg, finger.stiffness_n_per_m, finger.damping_n_s_per_m,
      contact.pad_n_per_m, contact.support_n_per_m, speed_m_s, depth_m, start_s, window_s, windows);
  const auto run = testing::run_program({"/usr/bin/python3", "-c", script});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream lines{run.standard_output};
  Eigen::ArrayXd impulses{windows};
  for (double& impulse : impulses) {
    REQUIRE(lines >> impulse);
  }
  return impulses;
}
}  // namespace

TEST_CASE("with shorter ticks a coupled finger converges to SciPy's solution", "[core][coupled]") {
  double error_before = 0.06;
  for (const double rate_hz : {1000.0, 4000.0, 16'000.0}) {
    const double phase = 0.3;
    const Eigen::ArrayXd exact = solved_impulses((phase - 1.0) / rate_hz);
    const Eigen::ArrayXd ours = rendered_impulses(rate_hz, phase);
    const double error = (ours - exact).matrix().norm() / exact.matrix().norm();
    INFO(rate_hz << " Hz: " << error);
    // of first order: the support's force is that of the tick's end, as a wall's is
    CHECK(error < error_before / 3.5);
    error_before = error;
  }
}

namespace {
// Decay rates [1/s] of the coupled motion of one mode and a finger pressed on it by a hand at rest:
// the eigenvalues of the equations of coupled_finger.hpp, slowest first.
double slowest_decay_per_s(const Mode& mode, const Finger& finger,
                           const ContactStiffness& contact) {
  const double omega = 2.0 * std::numbers::pi * mode.frequency_hz;
  const double p = mode.shape;
  const double pad = contact.pad_n_per_m;
  Eigen::Matrix4d rates;
  rates << 0.0, 1.0, 0.0, 0.0,                                                            //
      -omega * omega - p * p * (pad + contact.support_n_per_m),                           //
      -2.0 * mode.damping_ratio * omega, p * pad, 0.0,                                    //
      0.0, 0.0, 0.0, 1.0,                                                                 //
      p * pad / finger.mass_kg, 0.0, -(pad + finger.stiffness_n_per_m) / finger.mass_kg,  //
      -finger.damping_n_s_per_m / finger.mass_kg;
  return -tapstudy::core::eigenvalues(rates).real().maxCoeff();
}
}  // namespace

TEST_CASE("a resting finger damps the plate as the coupled equations say, and more than none",
          "[core][coupled]") {
  const Mode mode{120.0, 0.002, 3.0};
  const RenderSettings settings = settings_at(10'000.0);
  const VibratingPlate plate =
      testing::uniform_plate(Eigen::ArrayXd::Constant(1, mode.frequency_hz), mode.damping_ratio,
                             Eigen::ArrayXd::Constant(1, mode.shape));
  TapRenderer renderer =
      make_renderer(*find_technique("fem-coupled"), settings, PlateFace{0.3, 0.3}, &plate);
  std::vector<double> force_n;
  renderer.tick(hand_at(-0.5 * settings.dt_s));
  for (int tick = 0; tick < 7000; ++tick) {
    force_n.push_back(renderer.tick(hand_at((tick + 0.5) * settings.dt_s)).parts.vibration_n);
  }
  const auto swing = [&](std::size_t from) {
    const auto begin = force_n.begin() + static_cast<std::ptrdiff_t>(from);
    const auto [low, high] = std::minmax_element(begin, begin + 1000);
    return *high - *low;
  };
  const double decay_per_s = std::log(swing(2500) / swing(5000)) / (2500.0 * settings.dt_s);
  const double free_per_s = mode.damping_ratio * 2.0 * std::numbers::pi * mode.frequency_hz;
  CHECK(decay_per_s ==
        Approx(slowest_decay_per_s(
                   mode, settings.finger,
                   contact_stiffness_beside(settings.finger, settings.penalty_stiffness_n_per_m)))
            .epsilon(0.02));
  CHECK(decay_per_s > 3.0 * free_per_s);
}

TEST_CASE("rendering a coupled finger allocates nothing", "[core][coupled][realtime]") {
  const VibratingPlate plate = plate_of_three_modes();
  TapRenderer renderer = make_renderer(*find_technique("fem-coupled"), settings_at(1000.0),
                                       PlateFace{0.3, 0.3}, &plate);
  const testing::AllocationCount allocations;
  for (int tick = 0; tick < 10'000; ++tick) {
    renderer.tick({{0.0001 * (tick % 1000), 0.0, 0.002 * std::sin(0.05 * tick)}, Vec3::Zero()});
  }
  CHECK(allocations.count() == 0);
}
