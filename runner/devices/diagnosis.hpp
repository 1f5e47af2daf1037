#pragma once
#include <optional>
#include <string>

#include "device/loop/loop_probe.hpp"
namespace tapstudy::runner {
// Measured real-time performance of the machine.
struct Diagnosis {
  device::Nanoseconds period{};
  std::string governor;
  device::ProbedLoop idle;
  std::optional<device::ProbedLoop> loaded;
  std::optional<device::LatenessCount> round_trip;  // of the device's board, request to reply
};

enum class Under { no_load, load_too };
// Takes `seconds`, or twice that if measured under load too. round_trip comes from the device.
Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under);
// The verdict in words; `holds` is false if even the idle machine cannot sustain the loop.
struct Verdict {
  bool holds{};
  std::string words;
};
Verdict verdict_of(const Diagnosis& diagnosis);
// For the session's record.
std::string to_json(const Diagnosis& diagnosis);
}  // namespace tapstudy::runner
