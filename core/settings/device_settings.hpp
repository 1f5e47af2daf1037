#pragma once
#include <array>
#include <limits>
#include <optional>

#include "core/tick/force_limiter.hpp"
namespace tapstudy::core {
// A simulated hand: finger, grip and device as one mass driven through a muscle spring-damper.
struct HandBody {
  double mass_kg{0.1};
  double muscle_stiffness_n_per_m{400.0};
  double muscle_damping_n_s_per_m{9.0};
};

inline constexpr int spidar_strings = 8;

// Calibration to be measured on each individual SPIDAR, string by string: published values of force
// per volt differ by a factor of three for the same frame.
struct StringCalibration {
  double metres_per_count{};  // of string paid out per positive encoder count; signed
  double volts_per_newton{};
  double dac_counts_per_volt{};
};

struct SpidarCalibration {
  double min_tension_n{0.3};  // below it a string goes slack
  double max_tension_n{0.3};
  std::array<StringCalibration, spidar_strings> strings{};
};

// Limits applied to every force before it reaches a device.
struct GateSettings {
  ForceLimits limits;
  double max_hand_speed_m_s{std::numeric_limits<double>::infinity()};
  double workspace_radius_m{std::numeric_limits<double>::infinity()};  // from the device's origin
  double force_rise_s{0.0};  // from zero to full force when rendering starts; 0: at once
  double force_fall_s{0.0};  // from full to zero force at a soft stop
};

// Real-time facilities requested for the haptic loop. Any of them may be refused.
struct RealtimeRequest {
  int fifo_priority{80};  // SCHED_FIFO, and no deep CPU idle states; 0: not requested
  bool lock_memory{true};
  std::optional<int> cpu{};  // CPU affinity
};
}  // namespace tapstudy::core
