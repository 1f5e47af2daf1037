#pragma once
#include <array>
#include <atomic>
namespace tapstudy::testing {
// What the stand-in for a device of the DHD interface shares with the test that runs it
// (MappedStandIn).
struct DhdStandIn {
  static constexpr const char* variable = "TAPSTUDY_DHD_STAND_IN";
  std::atomic<bool> has_watchdog{true};
  std::atomic<bool> is_gone{false};
  std::atomic<int> watchdog{0};
  std::atomic<bool> is_force_enabled{false};
  std::array<std::atomic<double>, 3> force_n{};  // in the interface's frame
};
}  // namespace tapstudy::testing
