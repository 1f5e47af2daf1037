#pragma once
#include <optional>
#include <string>

#include "device/loop/loop_probe.hpp"
namespace tapstudy::runner {
// What a machine can do for the loop, measured.
struct Diagnosis {
  device::Nanoseconds period{};
  std::string governor;
  device::ProbedLoop idle;
  std::optional<device::ProbedLoop> loaded;
  std::optional<device::LatenessCount> round_trip;  // of the device's board, request to reply
};

enum class Under { no_load, load_too };
// Takes `seconds`, twice that under load too. The round trip is the device's to tell.
Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under);
// A sentence; `holds` is false if even the idle machine does not hold the loop.
struct Verdict {
  bool holds{};
  std::string words;
};
Verdict verdict_of(const Diagnosis& diagnosis);
// For the session's record.
std::string to_json(const Diagnosis& diagnosis);
}  // namespace tapstudy::runner
