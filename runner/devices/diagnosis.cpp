#include "runner/devices/diagnosis.hpp"

#include <nlohmann/json.hpp>

#include "runner/devices/machine_facts.hpp"
namespace tapstudy::runner {
namespace {
using Json = nlohmann::ordered_json;

bool is_fit(const device::ProbedLoop& probed, device::Nanoseconds period) {
  return probed.late == 0 && probed.lateness.quantile(0.999) < max_p999_lateness(period);
}

RepeatedProbe probe_repeatedly(const core::RealtimeRequest& request, device::Nanoseconds period,
                               double seconds, const std::function<void()>& work = {}) {
  RepeatedProbe all;
  for (; all.made < probes; ++all.made) {
    const device::ProbedLoop one = device::probe_loop(request, period, seconds / probes, work);
    all.fit += is_fit(one, period) ? 1 : 0;
    all.total.realtime = one.realtime;
    all.total.timer_slack_ns = one.timer_slack_ns;
    all.total.lateness.add(one.lateness);
    all.total.late += one.late;
    all.total.work.add(one.work);
  }
  return all;
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

Json json_of(const RepeatedProbe& probed) {
  Json json = json_of(probed.total.lateness);
  json["late"] = probed.total.late;
  json["measurements"] = probed.made;
  json["measurements_that_hold"] = probed.fit;
  return json;
}
}  // namespace

device::Nanoseconds max_lateness(device::Nanoseconds period) {
  return period / 2;
}

device::Nanoseconds max_p999_lateness(device::Nanoseconds period) {
  return period / 4;
}

Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under, const std::function<void()>& exchange) {
  Diagnosis diagnosis;
  diagnosis.period = period;
  diagnosis.machine = machine_facts();
  diagnosis.idle = probe_repeatedly(request, period, seconds);
  if (exchange) {
    diagnosis.on_device = probe_repeatedly(request, period, seconds, exchange);
    diagnosis.round_trip = diagnosis.on_device->total.work;
  }
  if (under == Under::load_too) {
    const device::Load load;
    diagnosis.loaded = probe_repeatedly(request, period, seconds);
  }
  return diagnosis;
}

Verdict verdict_of(const Diagnosis& diagnosis) {
  if (!diagnosis.idle.holds()) {
    return {false, "this machine cannot hold the loop, even with nothing else to do"};
  }
  if (!is_quick(diagnosis) || (diagnosis.on_device && !diagnosis.on_device->holds())) {
    return {false,
            "this machine holds the loop, but the device's reply takes more than half a period"};
  }
  if (!diagnosis.loaded) {
    return {true, "this machine holds the loop with nothing else to do"};
  }
  return {true, diagnosis.loaded->holds()
                    ? "this machine holds the loop, under load too"
                    : "this machine holds the loop as long as nothing else runs on it: close "
                      "other programs during a session"};
}

std::string to_json(const Diagnosis& diagnosis) {
  Json json{{"rate_hz", 1e9 / static_cast<double>(diagnosis.period)},
            {"timer_slack_ns", diagnosis.idle.total.timer_slack_ns},
            {"idle", json_of(diagnosis.idle)}};
  for (const auto& [name, value] : diagnosis.machine) {
    json["machine"][name] = value;
  }
  if (!diagnosis.sleep.empty()) {
    json["sleep"] = diagnosis.sleep;
  }
  if (diagnosis.loaded) {
    json["loaded"] = json_of(*diagnosis.loaded);
  }
  if (diagnosis.on_device) {
    json["on_device"] = json_of(*diagnosis.on_device);
  }
  if (diagnosis.round_trip) {
    json["round_trip"] = json_of(*diagnosis.round_trip);
  }
  json["verdict"] = verdict_of(diagnosis).words;
  return json.dump();
}
}  // namespace tapstudy::runner
