#pragma once
#include <array>
#include <atomic>
#include <cstdint>
namespace tapstudy::testing {
// What the stand-in for a device of the DHD interface shares with the test that runs it
// (MappedStandIn).
struct DhdStandIn {
  static constexpr const char* variable = "TAPSTUDY_DHD_STAND_IN";
  std::atomic<bool> has_watchdog{true};
  std::atomic<bool> is_gone{false};
  std::atomic<bool> is_hung{false};         // no sample is new
  std::atomic<bool> is_lost{false};         // its position is NaN
  std::atomic<bool> is_every_other{false};  // sample new
  std::atomic<double> tremor_m{0.0};        // with each sample
  std::atomic<int> watchdog{0};
  std::atomic<bool> is_force_enabled{false};
  std::array<std::atomic<double>, 3> force_n{};  // in the interface's frame
  std::atomic<double> largest_n{0.0};            // upwards
  std::atomic<std::int64_t> asked_at_ns{0};      // of the steady clock
};
}  // namespace tapstudy::testing
