#pragma once
#include <string>
#include <vector>

#include "core/tick/vibrating_plate.hpp"
#include "protocols/rig.hpp"
#include "runner/session/participants/simulated_observer.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/studies/scripted_tap.hpp"
namespace tapstudy::runner {
inline constexpr double shown_s = 0.3;  // from a little before the impact on
inline constexpr double low_limit_hz = 100.0;

// The force of a tap from its trace, from the impact on.
struct TapForce {
  double penalty_n{};  // largest magnitudes
  double vibration_n{};
  double low_n{};   // of the vibration below 100 Hz, by the discrete Fourier transform
  double high_n{};  // and of the rest
  std::vector<double> t_s;
  std::vector<double> penalty;  // [N]
  std::vector<double> vibration;
};
// Throws InvalidInput if there is no impact.
TapForce tap_force(const std::vector<core::TraceSample>& trace, double rate_hz);

// The whole force over time, and the vibration alone below it, both in newtons.
std::string force_svg(const TapForce& force, const std::string& title);

// Settings for the force of a real plate on a finger, as far as tapstudy can compute it: a bare
// finger of 5.8 g, coupled to the plate by its pad for as long as it touches
// (core/tick/coupled_finger.hpp), at 48 kHz with the exact integrator, at three times the speed on
// a virtual plate, because the paper says that its users' hands moved around three times slower
// there.
inline constexpr double real_rate_hz = 48'000.0;
inline constexpr double real_finger_kg = 0.0058;
inline constexpr double real_over_virtual_speed = 3.0;

// One tap, 0.9 m/s, by a hand that comes down at constant speed and stops 2 mm below the surface,
// from the impact on, a value for each tick.
struct RealTap {
  Eigen::VectorXd finger_m_s2;  // acceleration of its tip
  Eigen::VectorXd plate_m_s2;   // and of the plate below it
  Eigen::VectorXd force_n;      // of the finger on the hand
};
// Requires the settings of with_real_finger(). Without a plate the surface is rigid.
RealTap real_tap(const core::VibratingPlate* plate, const core::RenderSettings& settings,
                 const Eigen::Vector2d& at_m, double seconds);

// The protocol with every stimulus as its real plate.
protocols::Protocol with_real_finger(protocols::Protocol protocol);

// The simulated hand's rig without limits: a real plate has none.
protocols::Rig unlimited_rig();

// The taps that a hand felt on a tapping point of a stimulus, one impact at this speed.
std::vector<FeltTap> felt_tap(const protocols::Protocol& protocol, const std::string& stimulus,
                              const std::string& point, double speed_m_s, ModelLibrary& models);

// Level of one felt tap: the power of all its third octaves, early and late, in decibels of the
// observer's threshold; below 0 where nothing is felt.
double level_db(const FeltTap& tap);
}  // namespace tapstudy::runner
