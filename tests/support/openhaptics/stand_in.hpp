#pragma once
#include <array>
#include <atomic>
namespace tapstudy::testing {
// What the stand-in for a device of the HDAPI shares with the test that runs it (MappedStandIn).
struct OpenHapticsStandIn {
  static constexpr const char* variable = "TAPSTUDY_OPENHAPTICS_STAND_IN";
  std::atomic<bool> is_gone{false};
  std::atomic<bool> is_hung{false};              // its servo loop stands still
  std::atomic<bool> is_lost{false};              // its position is NaN
  std::atomic<bool> is_every_other{false};       // tick made
  std::atomic<double> tremor_m{0.0};             // with each frame
  std::atomic<bool> is_running{false};           // its servo loop
  std::array<std::atomic<double>, 3> force_n{};  // of the last frame
  std::atomic<double> largest_n{0.0};            // upwards
};
}  // namespace tapstudy::testing
