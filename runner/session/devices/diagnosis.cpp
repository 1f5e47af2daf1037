#include "runner/session/devices/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>
namespace tapstudy::runner {
// Settings of this machine that decide how punctual a loop can be: name and value of each, with
// what to do where a value is known to be bad.
std::vector<std::pair<std::string, std::string>> machine_facts();

namespace {
namespace fs = std::filesystem;

// The first line; empty if it cannot be read.
std::string line_of(const fs::path& file) {
  std::ifstream stream{file};
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string or_unknown(const std::string& text) {
  return text.empty() ? "unknown (a virtual machine?)" : text;
}

std::string kernel() {
  utsname name{};
  uname(&name);
  const std::string version{static_cast<const char*>(name.version)};
  const char* const kind = version.find("PREEMPT_RT") != std::string::npos ? "real-time"
                           : version.find("PREEMPT") != std::string::npos  ? "preemptible"
                                                                           : "not preemptible";
  return fmt::format("{}, {}", static_cast<const char*>(name.release), kind);
}

std::string clock_source() {
  const std::string source =
      line_of("/sys/devices/system/clocksource/clocksource0/current_clocksource");
  return source == "hpet" || source == "acpi_pm" ? source + " (slow to read: tsc is better)"
                                                 : or_unknown(source);
}

std::string limit(__rlimit_resource resource) {
  rlimit found{};
  getrlimit(resource, &found);
  return found.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(found.rlim_cur);
}

std::string real_time_share() {
  const std::string runtime_us = line_of("/proc/sys/kernel/sched_rt_runtime_us");
  return runtime_us == "-1" ? "unlimited"
                            : fmt::format("{} us of {} us", or_unknown(runtime_us),
                                          line_of("/proc/sys/kernel/sched_rt_period_us"));
}

std::string governor() {
  const std::string found = line_of("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  return found.empty() || found == "performance"
             ? or_unknown(found)
             : found + " (slow to speed up: sudo cpupower frequency-set -g performance)";
}

std::string isolated_processors() {
  const std::string found = line_of("/sys/devices/system/cpu/isolated");
  return found.empty()
             ? "none (isolcpus=N on the kernel's command line, and loop.cpu: N in the rig)"
             : found;
}

// Threads that handle the USB controller's interrupts, on kernels that have such.
std::string usb_interrupt_threads() {
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator{"/proc"}) {
    const std::string name = entry.path().filename();
    int process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    const std::string command = error == std::errc{} ? line_of(entry.path() / "comm") : "";
    if (command.starts_with("irq/") && command.find("hci") != std::string::npos) {
      sched_param parameters{};
      sched_getparam(process, &parameters);
      found.push_back(fmt::format("{} FIFO {}", command, parameters.sched_priority));
    }
  }
  return found.empty()
             ? "none: replies are handled in the interrupt itself"
             : fmt::format("{} (must be above the loop's priority: chrt)", fmt::join(found, ", "));
}
}  // namespace

std::vector<std::pair<std::string, std::string>> machine_facts() {
  return {{"kernel", kernel()},
          {"clock", clock_source()},
          {"governor", governor()},
          {"isolated", isolated_processors()},
          {"idle", or_unknown(line_of("/sys/devices/system/cpu/cpuidle/current_driver"))},
          {"rt share", real_time_share()},
          {"rtprio", limit(RLIMIT_RTPRIO)},
          {"memlock", limit(RLIMIT_MEMLOCK)},
          {"usb irq", usb_interrupt_threads()}};
}

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
  if (!diagnosis.release.empty()) {
    json["release"] = diagnosis.release;
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
