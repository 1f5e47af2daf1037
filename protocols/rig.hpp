#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "core/placement.hpp"
#include "core/tick/force_limiter.hpp"
namespace tapstudy::protocols {
// What is asked of the machine for the loop, and how much lateness ends a trial.
struct LoopRig {
  int fifo_priority{80};  // 0: not asked for
  bool lock_memory{true};
  std::optional<int> cpu;
  int most_late_ticks_in_a_row{0};  // 0: any
};

// What was measured on one SPIDAR, string by string.
struct StringRig {
  double metres_per_count{};  // the sign says which way the encoder counts
  double volts_per_newton{};
  double digits_per_volt{};
};
struct SpidarRig {
  std::string type;
  std::optional<int> rotary_switch;  // of the board that is meant, where there are several
  double max_turn_rad{0.3};          // of the grip, from how it was homed
  double longest_reply_s{0.003};     // of the board to a tick's question
  double min_tension_n{};
  double max_tension_n{};
  std::array<StringRig, 8> strings;
};

// The hand of a trial that is stored already.
struct ReplayRig {
  std::string directory;  // of its study
  std::int64_t trial_id{};
};

// What surrounds the study: the device and what it may do.
struct Rig {
  std::string text;  // all that it was read from, a calibration as a second document
  std::string device;
  core::ForceLimits limits;
  double max_hand_speed_m_s{std::numeric_limits<double>::infinity()};
  double workspace_radius_m{std::numeric_limits<double>::infinity()};
  double force_rise_s{0.0};
  double force_fall_s{0.0};
  LoopRig loop;
  std::optional<SpidarRig> spidar;
  std::optional<std::uint16_t> remote_port;
  std::optional<ReplayRig> replay;
  std::optional<core::Placement> placement;  // instead of the protocol's

  // A hand that is neither simulated nor recorded, and can be hurt.
  bool has_hardware() const noexcept { return spidar || remote_port; }
};
}  // namespace tapstudy::protocols
