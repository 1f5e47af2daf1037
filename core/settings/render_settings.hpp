#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>
namespace tapstudy::core {
// A device's measured response to a commanded vibration: force at the grip over force commanded, in
// magnitude.
struct DeviceResponse {
  struct Point {
    double frequency_hz{};  // ascending, > 0
    double gain{};          // > 0; 1: as commanded
  };
  std::vector<Point> points;  // at least one; straight lines between them on logarithmic axes
  double max_boost{4.0};      // no frequency is amplified by more
};

// The force on a finger after an impact, as it was measured: along the outward normal, from the
// impact on.
struct RecordedTap {
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};  // plate frame
  double speed_m_s{};                             // of the impact; > 0
  std::vector<double> force_n;
};

struct RecordedTaps {
  double rate_hz{};  // of the samples; > 0
  std::vector<RecordedTap> taps;
};

// Time integration of the modes: the exact recurrence of a damped oscillator, or Newmark's method
// with beta = 1/4, gamma = 1/2 (paper section 4.2.1).
enum class Integrator { exact, newmark };

// The paper's finger model: the striking mass (eq. 14, grip included) and the spring and damper
// through which vibration is felt (eq. 17). For a coupled finger (core/tick/coupled_finger.hpp),
// mass_kg is the mass that the spring and damper hold to the hand.
struct Finger {
  double mass_kg{0.058};
  double stiffness_n_per_m{300.0};
  double damping_n_s_per_m{3.0};
};

// A e^(-decay t) sin(2 pi frequency t), A proportional to the impact speed (paper section 5.2.3,
// after Okamura et al. 1998).
struct SinusoidShape {
  double amplitude_n_s_per_m{};  // A per unit impact speed
  double decay_per_s{600.0};
  double frequency_hz{250.0};
  // That tells where the impact was (the simplified model of Sreng, Lécuyer & Andriot 2008): from
  // one place to another amplitude and frequency change in proportion, up to these factors.
  struct ByPlace {
    std::array<double, 2> from_m{};  // plate frame
    std::array<double, 2> to_m{};    // another one
    double amplitude_factor{1.0};
    double frequency_factor{1.0};
    // The position of the nearest point of the segment, from 0 at its start to 1 at its end;
    // clamped beyond the ends.
    double share_at(double x_m, double y_m) const noexcept {
      const double along_x_m = to_m[0] - from_m[0];
      const double along_y_m = to_m[1] - from_m[1];
      const double share = ((x_m - from_m[0]) * along_x_m + (y_m - from_m[1]) * along_y_m) /
                           (along_x_m * along_x_m + along_y_m * along_y_m);
      return std::clamp(share, 0.0, 1.0);
    }
  };
  std::optional<ByPlace> by_place{};  // unset: the same everywhere
  double highest_frequency_hz() const {
    return frequency_hz * (by_place ? std::max(1.0, by_place->frequency_factor) : 1.0);
  }
};

// Where vibration is divided between the force device and an actuator beside it. A vibration of one
// frequency, a mode or a sinusoid, is rendered by the device below both edges, by the actuator
// above both, and in between by both, in shares that sum to one.
struct Crossover {
  double low_hz{};
  double high_hz{};  // > low_hz
  // sin²(pi x / 2), x the place between the edges on a logarithmic axis.
  double actuator_share(double frequency_hz) const {
    const double x = std::log(frequency_hz / low_hz) / std::log(high_hz / low_hz);
    const double root = std::sin(0.5 * std::numbers::pi * std::clamp(x, 0.0, 1.0));
    return x >= 1.0 ? 1.0 : root * root;
  }
};

struct RenderSettings {
  double dt_s{1e-3};
  double penalty_stiffness_n_per_m{3000.0};  // k of eq. 1
  double release_height_m{5e-4};             // hysteresis: re-arms impacts above this
  double lateral_ratio{1.0};                 // of the plate's lateral scale to the placement's
  double vibration_gain{1.0};                // factor on the vibration force, eq. 17 or recorded
  Integrator integrator{Integrator::exact};
  Finger finger;
  SinusoidShape sinusoid;
  std::shared_ptr<const RecordedTaps> recorded_taps;        // of the stimulus; may be null
  std::shared_ptr<const DeviceResponse> device_response{};  // undone in recordings; null: unknown
  std::optional<Crossover> crossover{};                     // unset: the device renders all
};
}  // namespace tapstudy::core
