// What an actuator beside the force device renders, against the undivided force and closed forms.
#include "core/tick/actuator_voice.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

#include "core/techniques/actuated.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/plate_vibration.hpp"
#include "support/catch.hpp"
#include "support/no_alloc.hpp"
#include "support/plates.hpp"
using namespace tapstudy::core;
namespace testing = tapstudy::testing;

namespace {
constexpr double audio_rate_hz = 48'000.0;
constexpr int samples_a_tick = 48;
constexpr double tapped_m_s = 0.3;

RenderSettings divided_at(double dt_s) {
  RenderSettings settings;
  settings.dt_s = dt_s;
  settings.sinusoid = {.amplitude_n_s_per_m = 3.0, .decay_per_s = 600.0, .frequency_hz = 260.0};
  settings.crossover = Crossover{200.0, 320.0};
  return settings;
}

ActuatorTick touching_at(double x_m, double y_m, bool impact = false) {
  Contact contact;
  contact.touching = true;
  contact.impact = impact;
  contact.impact_speed_m_s = impact ? tapped_m_s : 0.0;
  contact.god_object_m = {x_m, y_m, 0.0};
  ActuatorTick tick = actuator_tick(contact);
  tick.passed_share = 1.0;
  return tick;
}

VibratingPlate plate_with(const ModalModel& model) {
  return VibratingPlate{model};
}

// Below, in and above the crossover of 200 to 320 Hz; the fourth beyond what a loop of 1 kHz
// renders.
VibratingPlate four_modes() {
  return testing::uniform_plate(Eigen::Array4d{90.0, 250.0, 300.0, 1900.0}, 0.01,
                                Eigen::Array4d{0.5, -0.4, 0.3, 0.8});
}

// Struck once, and touched from then on.
std::vector<double> forces_of(ActuatorVoice& voice, int samples) {
  std::vector<double> forces_n;
  for (int i = 0; i < samples; ++i) {
    voice.advance();
    if (i % samples_a_tick == 0) {
      voice.begin(touching_at(0.0, 0.0, i == 0), samples_a_tick);
    }
    forces_n.push_back(voice.force_n());
  }
  return forces_n;
}

std::vector<double> forces_of(AddedForce& force, int samples) {
  std::vector<double> forces_n;
  Contact contact;
  contact.touching = true;
  for (int i = 0; i < samples; ++i) {
    force.advance(1);
    force.touch(contact);
    if (i == 0) {
      force.impact(tapped_m_s);
    }
    ForceParts parts;
    force.add_to(parts);
    forces_n.push_back(parts.vibration_n + parts.sinusoid_n);
  }
  return forces_n;
}
}  // namespace

TEST_CASE("what device and actuator render of a body adds up to the undivided vibration",
          "[core][actuator]") {
  const VibratingPlate whole = four_modes();
  const RenderSettings settings = divided_at(1.0 / audio_rate_hz);
  const VibratingPlate devices =
      plate_with(share_of(whole.model, *settings.crossover, RenderedBy::device));
  const VibratingPlate actuators =
      plate_with(share_of(whole.model, *settings.crossover, RenderedBy::actuator));
  CHECK(devices.model.frequency_hz.size() == 3);    // all but the highest
  CHECK(actuators.model.frequency_hz.size() == 3);  // all but the lowest
  PlateVibration undivided{whole, settings};
  PlateVibration device{devices, settings};
  ActuatorVoice actuator = make_voice(*find_technique("fem"), settings, &actuators,
                                      ActuatorResponse::flat(), settings.dt_s);
  constexpr int samples = 48'000;
  const auto all_n = forces_of(undivided, samples);
  const auto device_n = forces_of(device, samples);
  const auto actuator_n = forces_of(actuator, samples);
  double worst_n = 0.0;
  for (std::size_t i = 0; i < all_n.size(); ++i) {
    worst_n = std::max(worst_n, std::abs(device_n[i] + actuator_n[i] - all_n[i]));
  }
  CHECK(worst_n < 1e-12);
}

TEST_CASE("what device and actuator render of a sinusoid adds up to the undivided one",
          "[core][actuator]") {
  const Technique& technique = *find_technique("sinusoid");
  const RenderSettings divided = divided_at(1.0 / audio_rate_hz);
  RenderSettings undivided = divided;
  undivided.crossover.reset();
  const auto all_n = forces_of(*decaying_sinusoid.make(undivided, nullptr), 2000);
  const auto device_n = forces_of(*decaying_sinusoid.make(divided, nullptr), 2000);
  ActuatorVoice actuator =
      make_voice(technique, divided, nullptr, ActuatorResponse::flat(), divided.dt_s);
  const auto actuator_n = forces_of(actuator, 2000);
  for (std::size_t i = 0; i < all_n.size(); ++i) {
    CHECK(device_n[i] + actuator_n[i] == Approx(all_n[i]).margin(1e-12));
  }
  CHECK(std::abs(actuator_n[20]) > 0.01);
  CHECK(std::abs(device_n[20]) > 0.01);
}

TEST_CASE("what device and actuator render of a recording adds up to the undivided one",
          "[core][actuator][recorded]") {
  const Technique& technique = *find_technique("recorded");
  RenderSettings divided = divided_at(1.0 / audio_rate_hz);
  RecordedTap tap;
  tap.speed_m_s = 2.0 * tapped_m_s;
  for (int i = 0; i < 4800; ++i) {
    const double t_s = i / audio_rate_hz;
    tap.force_n.push_back(std::exp(-40.0 * t_s) * (std::cos(2.0 * std::numbers::pi * 90.0 * t_s) +
                                                   std::sin(2.0 * std::numbers::pi * 900.0 * t_s)));
  }
  divided.recorded_taps = std::make_shared<const RecordedTaps>(RecordedTaps{audio_rate_hz, {tap}});
  RenderSettings undivided = divided;
  undivided.crossover.reset();
  constexpr int samples = 4800;
  const auto all_n = forces_of(*recorded_transient.make(undivided, nullptr), samples);
  const auto device_n = forces_of(*recorded_transient.make(divided, nullptr), samples);
  ActuatorVoice actuator =
      make_voice(technique, divided, nullptr, ActuatorResponse::flat(), divided.dt_s);
  const auto actuator_n = forces_of(actuator, samples);
  double worst_n = 0.0;
  double low_n = 0.0;
  double high_n = 0.0;
  for (std::size_t i = 0; i < all_n.size(); ++i) {
    worst_n = std::max(worst_n, std::abs(device_n[i] + actuator_n[i] - all_n[i]));
    const double t_s = static_cast<double>(i) / audio_rate_hz;
    const double fall = 0.5 * std::exp(-40.0 * t_s);  // half of the recording's speed
    const bool is_inside = t_s > 0.01 && t_s < 0.09;  // beyond the filter's ringing at the ends
    low_n = std::max(low_n, is_inside ? std::abs(device_n[i] / fall -
                                                 std::cos(2.0 * std::numbers::pi * 90.0 * t_s))
                                      : 0.0);
    high_n = std::max(high_n, is_inside ? std::abs(actuator_n[i] / fall -
                                                   std::sin(2.0 * std::numbers::pi * 900.0 * t_s))
                                        : 0.0);
  }
  CHECK(worst_n < 1e-12);
  CHECK(low_n < 0.05);
  CHECK(high_n < 0.05);
}

TEST_CASE("every sample of the actuator is that of the closed form", "[core][actuator]") {
  const double hz = 1900.0;
  const double damping_ratio = 0.004;
  const double shape = 0.7;
  const VibratingPlate plate = testing::uniform_plate(
      Eigen::ArrayXd::Constant(1, hz), damping_ratio, Eigen::ArrayXd::Constant(1, shape));
  const RenderSettings settings = divided_at(1e-3);
  ActuatorVoice voice = make_voice(*find_technique("fem"), settings, &plate,
                                   ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  const auto forces_n = forces_of(voice, 48'000);
  // q = v0 e^(-zeta w t) sin(w_d t) / w_d for the velocity v0 that the impulse gives (eq. 11, 15)
  const double omega = 2.0 * std::numbers::pi * hz;
  const double turning = omega * std::sqrt(1.0 - damping_ratio * damping_ratio);
  const double v0 = -settings.finger.mass_kg * tapped_m_s * shape;
  double worst_n = 0.0;
  for (std::size_t i = 0; i < forces_n.size(); ++i) {
    const double t_s = static_cast<double>(i) / audio_rate_hz;
    const double envelope = v0 * std::exp(-damping_ratio * omega * t_s);
    const double q = envelope * std::sin(turning * t_s) / turning;
    const double v = envelope * std::cos(turning * t_s) - damping_ratio * omega * q;
    const double expected_n =
        shape * (settings.finger.stiffness_n_per_m * q + settings.finger.damping_n_s_per_m * v);
    worst_n = std::max(worst_n, std::abs(forces_n[i] - expected_n));
  }
  const double largest_n = std::abs(forces_n.front());
  CHECK(largest_n > 0.01);
  CHECK(worst_n < 1e-9 * largest_n);
}

TEST_CASE("an actuator that lags and weakens is led and driven harder, as far as its boost allows",
          "[core][actuator]") {
  const VibratingPlate plate = testing::uniform_plate(Eigen::ArrayXd::Constant(1, 1000.0), 0.0,
                                                      Eigen::ArrayXd::Constant(1, 1.0));
  const RenderSettings settings = divided_at(1e-3);
  const auto forces_through = [&](const ActuatorResponse& response) {
    ActuatorVoice voice =
        make_voice(*find_technique("fem"), settings, &plate, response, 1.0 / audio_rate_hz);
    return forces_of(voice, 480);
  };
  const auto plain_n = forces_through(ActuatorResponse::flat());
  // between its points: half as strong and a quarter of a period behind at 1000 Hz
  const ActuatorResponse late{{{{500.0, 1.0}, {2000.0, 0.25}}, 4.0}, {0.0, -std::numbers::pi}};
  const auto led_n = forces_through(late);
  constexpr std::size_t quarter = 12;  // samples of a period of 48
  for (std::size_t i = 0; i + quarter < led_n.size(); ++i) {
    CHECK(led_n[i] == Approx(2.0 * plain_n[i + quarter]).margin(1e-9));
  }
  ActuatorResponse feeble = late;
  feeble.magnitude.max_boost = 1.5;
  const auto limited_n = forces_through(feeble);
  CHECK(limited_n[7] == Approx(0.75 * led_n[7]));
}

TEST_CASE("a finger that slides changes the weights of the modes evenly over a tick",
          "[core][actuator]") {
  VibratingPlate plate = testing::uniform_plate(Eigen::ArrayXd::Constant(1, 400.0), 0.0,
                                                Eigen::ArrayXd::Constant(1, 1.0));
  for (Eigen::Index node = 0; node < 4; ++node) {  // the shape grows along x
    plate.model.shape(3 * node + 2, 0) = 1.0 + plate.model.touch_nodes_m(node, 0);
  }
  const RenderSettings settings = divided_at(1e-3);
  const auto voice_of = [&] {
    return make_voice(*find_technique("fem"), settings, &plate, ActuatorResponse::flat(),
                      1.0 / audio_rate_hz);
  };
  ActuatorVoice still = voice_of();
  ActuatorVoice sliding = voice_of();
  const double slid_m = 0.2;
  for (int i = 0; i < 2 * samples_a_tick; ++i) {
    still.advance();
    sliding.advance();
    if (i % samples_a_tick == 0) {
      still.begin(touching_at(0.0, 0.0, i == 0), samples_a_tick);
      sliding.begin(touching_at(i == 0 ? 0.0 : slid_m, 0.0, i == 0), samples_a_tick);
    }
    const double way = std::max(0.0, static_cast<double>(i - samples_a_tick) / samples_a_tick);
    CHECK(sliding.force_n() == Approx((1.0 + slid_m * way) * still.force_n()).margin(1e-12));
  }
}

TEST_CASE(
    "a finger that lifts after sliding keeps the weights of its last place, and each contact "
    "begins at full force",
    "[core][actuator]") {
  VibratingPlate plate = testing::uniform_plate(Eigen::ArrayXd::Constant(1, 400.0), 0.0,
                                                Eigen::ArrayXd::Constant(1, 1.0));
  for (Eigen::Index node = 0; node < 4; ++node) {
    plate.model.shape(3 * node + 2, 0) = 1.0 + plate.model.touch_nodes_m(node, 0);
  }
  const RenderSettings settings = divided_at(1e-3);
  ActuatorVoice still = make_voice(*find_technique("fem"), settings, &plate,
                                   ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  ActuatorVoice sliding = still;
  const auto touches = [](int tick) { return tick < 3 || tick == 6; };
  for (int i = 0; i < 7 * samples_a_tick; ++i) {
    still.advance();
    sliding.advance();
    const int tick = i / samples_a_tick;
    if (i % samples_a_tick == 0) {
      ActuatorTick here = touching_at(0.0, 0.0, tick == 0);
      here.touching = touches(tick);
      still.begin(here, samples_a_tick);
      ActuatorTick there = touching_at(tick == 0 ? 0.0 : 0.2, 0.0, tick == 0);
      there.touching = touches(tick);
      sliding.begin(there, samples_a_tick);
    }
    if (tick >= 2) {
      CHECK(sliding.force_n() == Approx(1.2 * still.force_n()).margin(1e-12));
    }
    if (tick == 4 || tick == 5) {
      CHECK(still.force_n() == 0.0);
    }
  }
  ActuatorVoice never_lifted = make_voice(*find_technique("fem"), settings, &plate,
                                          ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  const auto forces_n = forces_of(never_lifted, 7 * samples_a_tick);
  CHECK(still.force_n() == Approx(forces_n.back()));
}

TEST_CASE("a mode that has died away is at rest, not at denormal numbers", "[core][actuator]") {
  const VibratingPlate plate = testing::uniform_plate(Eigen::ArrayXd::Constant(1, 1000.0), 0.08,
                                                      Eigen::ArrayXd::Constant(1, 1.0));
  ActuatorVoice voice = make_voice(*find_technique("fem"), divided_at(1e-3), &plate,
                                   ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  const auto forces_n = forces_of(voice, 48'000);  // e^-502 of what it was
  CHECK(forces_n[100] != 0.0);
  CHECK(forces_n.back() == 0.0);
}

TEST_CASE("a contact that ends fades within a tick, and force is as much as passed the limits",
          "[core][actuator]") {
  const VibratingPlate plate = testing::uniform_plate(Eigen::ArrayXd::Constant(1, 400.0), 0.0,
                                                      Eigen::ArrayXd::Constant(1, 1.0));
  const RenderSettings settings = divided_at(1e-3);
  ActuatorVoice whole = make_voice(*find_technique("fem"), settings, &plate,
                                   ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  ActuatorVoice half = whole;
  for (int i = 0; i < 3 * samples_a_tick; ++i) {
    whole.advance();
    half.advance();
    if (i % samples_a_tick == 0) {
      ActuatorTick tick = touching_at(0.0, 0.0, i == 0);
      tick.touching = i < samples_a_tick;
      whole.begin(tick, samples_a_tick);
      tick.passed_share = 0.5;
      half.begin(tick, samples_a_tick);
    }
    CHECK(half.force_n() == Approx(0.5 * whole.force_n()).margin(1e-15));
  }
  CHECK(whole.force_n() == 0.0);
}

TEST_CASE("nothing above its limits passes to an actuator, whatever comes in", "[core][actuator]") {
  const ActuatorLimits limits{2.0, 0.5};
  const auto input = GENERATE(0, 1, 2, 3);
  ActuatorLimiter limiter{limits, 1.0 / audio_rate_hz};
  std::mt19937 random{7};
  std::normal_distribution<double> normal;
  const double kept = std::exp(-1.0 / audio_rate_hz);
  double mean_square_n2 = 0.0;
  for (int i = 0; i < 200'000; ++i) {
    const double wild = i % 3 == 0   ? std::numeric_limits<double>::quiet_NaN()
                        : i % 3 == 1 ? std::numeric_limits<double>::infinity()
                                     : -1e300;
    const double in_n = input == 0   ? 5.0
                        : input == 1 ? 3.0 * normal(random)
                        : input == 2 ? 1.9 * std::sin(0.3 * i)
                                     : wild;
    const double out_n = limiter.limited(in_n);
    mean_square_n2 = kept * mean_square_n2 + (1.0 - kept) * out_n * out_n;
    REQUIRE(std::abs(out_n) <= limits.peak_n);
    REQUIRE(mean_square_n2 <= limits.rms_n * limits.rms_n * (1.0 + 1e-9));
  }
  ActuatorLimiter quiet{limits, 1.0 / audio_rate_hz};
  CHECK(quiet.limited(0.4) == 0.4);
}

TEST_CASE("an actuator's samples allocate nothing", "[core][actuator]") {
  const VibratingPlate plate = four_modes();
  const RenderSettings settings = divided_at(1e-3);
  ActuatorVoice voice = make_voice(*find_technique("fem+sinusoid"), settings, &plate,
                                   ActuatorResponse::flat(), 1.0 / audio_rate_hz);
  ActuatorLimiter limiter{{1.0, 0.5}, 1.0 / audio_rate_hz};
  const testing::AllocationCount allocations;
  for (int i = 0; i < 1000; ++i) {
    voice.advance();
    if (i % samples_a_tick == 0) {
      voice.begin(touching_at(0.01, 0.02, i == 0), samples_a_tick);
    }
    limiter.limited(voice.force_n());
  }
  voice.fade(10);
  voice.reset();
  CHECK(allocations.count() == 0);
}
