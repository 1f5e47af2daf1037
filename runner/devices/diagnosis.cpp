#include "runner/devices/diagnosis.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace tapstudy::runner {
namespace {
using Json = nlohmann::ordered_json;

std::string governor() {
  std::ifstream file{"/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"};
  std::string word;
  return file >> word ? word : "unknown (a virtual machine?)";
}

// A tick half a period late is felt as a click; a p99.9 of a quarter period leaves time for the
// tick's own computation.
bool is_fit(const device::ProbedLoop& probed, device::Nanoseconds period) {
  return probed.late == 0 && probed.lateness.quantile(0.999) < period / 4;
}

// The board's reply and the tick's own computation must fit into one period.
bool is_quick(const Diagnosis& diagnosis) {
  return !diagnosis.round_trip || diagnosis.round_trip->quantile(0.999) < diagnosis.period / 2;
}

Json json_of(const device::LatenessCount& times) {
  const auto seconds = [](device::Nanoseconds time) { return 1e-9 * static_cast<double>(time); };
  return {{"count", times.count()},
          {"p50_s", seconds(times.quantile(0.5))},
          {"p999_s", seconds(times.quantile(0.999))},
          {"worst_s", seconds(times.worst())}};
}

Json json_of(const device::ProbedLoop& probed) {
  Json json = json_of(probed.lateness);
  json["late"] = probed.late;
  return json;
}
}  // namespace

Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under) {
  Diagnosis diagnosis;
  diagnosis.period = period;
  diagnosis.governor = governor();
  diagnosis.idle = device::probe_loop(request, period, seconds);
  if (under == Under::load_too) {
    const device::Load load;
    diagnosis.loaded = device::probe_loop(request, period, seconds);
  }
  return diagnosis;
}

Verdict verdict_of(const Diagnosis& diagnosis) {
  if (!is_fit(diagnosis.idle, diagnosis.period)) {
    return {false, "this machine cannot hold the loop, even with nothing else to do"};
  }
  if (!is_quick(diagnosis)) {
    return {false,
            "this machine holds the loop, but the device's reply takes more than half a period"};
  }
  if (!diagnosis.loaded) {
    return {true, "this machine holds the loop with nothing else to do"};
  }
  return {true, is_fit(*diagnosis.loaded, diagnosis.period)
                    ? "this machine holds the loop, under load too"
                    : "this machine holds the loop as long as nothing else runs on it: close "
                      "other programs during a session"};
}

std::string to_json(const Diagnosis& diagnosis) {
  Json json{{"rate_hz", 1e9 / static_cast<double>(diagnosis.period)},
            {"governor", diagnosis.governor},
            {"timer_slack_ns", diagnosis.idle.timer_slack_ns},
            {"idle", json_of(diagnosis.idle)}};
  if (diagnosis.loaded) {
    json["loaded"] = json_of(*diagnosis.loaded);
  }
  if (diagnosis.round_trip) {
    json["round_trip"] = json_of(*diagnosis.round_trip);
  }
  json["verdict"] = verdict_of(diagnosis).words;
  return json.dump();
}
}  // namespace tapstudy::runner
