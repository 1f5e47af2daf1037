#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/loop/loop_probe.hpp"
namespace tapstudy::runner {
// The empty loop, measured several times for a while: one late tick by chance spoils one of them.
struct RepeatedProbe {
  device::ProbedLoop total;
  int fit{};  // how many measurements hold the loop
  int made{};
  bool holds() const noexcept { return 2 * fit > made; }
};

// Measured real-time performance of the machine.
struct Diagnosis {
  device::Nanoseconds period{};
  std::vector<std::pair<std::string, std::string>> machine;  // kernel, clock, governor, limits
  std::string release;                                       // SessionDevice::release()
  std::string sleep;  // whether the system agreed not to sleep; empty: not asked
  RepeatedProbe idle;
  std::optional<RepeatedProbe> loaded;
  std::optional<RepeatedProbe> on_device;           // with an exchange at zero force in each tick
  std::optional<device::LatenessCount> round_trip;  // of the device's board, request to reply
};

enum class Under { no_load, load_too };
inline constexpr int probes = 3;
// What a measurement must stay below to hold the loop: no tick later than half a period, which is
// felt as a click, and 99.9 % within a quarter, which leaves time for the tick's own computation.
device::Nanoseconds max_lateness(device::Nanoseconds period);
device::Nanoseconds max_p999_lateness(device::Nanoseconds period);
// Takes `seconds` for the idle machine, as much again under load, and as much again with an
// exchange with the device in each tick, whose times are the round trip then. Throws what the
// exchange does.
Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under, const std::function<void()>& exchange = {});
// The verdict in words; `holds` is false if even the idle machine cannot sustain the loop.
struct Verdict {
  bool holds{};
  std::string words;
};
Verdict verdict_of(const Diagnosis& diagnosis);
// For the session's record.
std::string to_json(const Diagnosis& diagnosis);
}  // namespace tapstudy::runner
