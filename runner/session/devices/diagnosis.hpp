#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/audio/card_probe.hpp"
#include "device/loop/loop_probe.hpp"
namespace tapstudy::runner {
// The actuator's card, with nothing else to do and under load.
struct DiagnosedCard {
  device::ProbedCard idle;
  device::ProbedCard loaded;
};

// Measured real-time performance of the machine.
struct Diagnosis {
  device::Nanoseconds period{};
  std::vector<std::pair<std::string, std::string>> machine;  // kernel, clock, governor, limits
  std::string release;                                       // SessionDevice::release()
  std::string sleep;        // whether the system agreed not to sleep; empty: not asked
  device::ProbedLoop idle;  // the empty loop
  std::optional<device::ProbedLoop> loaded;
  std::optional<device::ProbedLoop> on_device;      // with an exchange at zero force in each tick
  std::optional<device::LatenessCount> round_trip;  // of the device's board, request to reply
  std::optional<DiagnosedCard> actuator;
};

enum class Under { no_load, load_too };
// Settings of the machine that decide how punctual a loop can be: name and value of each, with the
// command that mends it where a value is known to be bad. root: of the file system.
std::vector<std::pair<std::string, std::string>> machine_facts(const std::filesystem::path& root);
// A loop holds if 99.9 % of its ticks are within a quarter of a period, which leaves time for the
// tick's own computation: yes or no where the 95 % interval of that quantile lies on one side.
enum class Holds { no, untold, yes };
device::Nanoseconds max_p999_lateness(device::Nanoseconds period);
Holds holds(const Diagnosis& diagnosis, const device::ProbedLoop& probed);
// A card is kept filled if it has no gap, and 99.9 % of its periods come within half of what its
// buffer bridges.
device::Nanoseconds max_p999_lateness(const device::ProbedCard& card);
Holds holds(const device::ProbedCard& card);
// Takes `seconds` for the idle machine, as much again under load, and as much again with an
// exchange with the device in each tick, whose times are the round trip then. Throws what the
// exchange does.
Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under, const std::function<void()>& exchange = {});
// The verdict in words; `holds` is false if it is shown that the machine, or the device, cannot
// sustain the loop.
struct Verdict {
  bool holds{};
  std::string words;
};
Verdict verdict_of(const Diagnosis& diagnosis);
// For the session's record.
std::string to_json(const Diagnosis& diagnosis);
}  // namespace tapstudy::runner
