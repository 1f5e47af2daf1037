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

std::string clock_source(const fs::path& root) {
  const std::string source =
      line_of(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  return source == "hpet" || source == "acpi_pm" ? source + " (slow to read: tsc is better)"
                                                 : or_unknown(source);
}

std::string limit(__rlimit_resource resource) {
  rlimit found{};
  getrlimit(resource, &found);
  return found.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(found.rlim_cur);
}

std::string real_time_share(const fs::path& root) {
  const std::string runtime_us = line_of(root / "proc/sys/kernel/sched_rt_runtime_us");
  return runtime_us == "-1" ? "unlimited"
                            : fmt::format("{} us of {} us", or_unknown(runtime_us),
                                          line_of(root / "proc/sys/kernel/sched_rt_period_us"));
}

std::string governor(const fs::path& root) {
  const std::string found = line_of(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  return found.empty() || found == "performance"
             ? or_unknown(found)
             : found + " (slow to speed up: sudo cpupower frequency-set -g performance)";
}

std::string isolated_processors(const fs::path& root) {
  const std::string found = line_of(root / "sys/devices/system/cpu/isolated");
  return found.empty()
             ? "none (isolcpus=N on the kernel's command line, and loop.cpu: N in the rig)"
             : found;
}

// Threads that handle the USB controller's interrupts, on kernels that have such.
std::string usb_interrupt_threads(const fs::path& root) {
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::directory_iterator{root / "proc"}) {
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

// What an adapter waits for before it passes on less than a full packet: a tick's reply.
std::string usb_serial_latency(const fs::path& root) {
  std::error_code none;
  std::vector<std::string> found;
  for (const fs::directory_entry& entry :
       fs::directory_iterator{root / "sys/bus/usb-serial/devices", none}) {
    const fs::path timer = entry.path() / "latency_timer";
    const std::string latency_ms = line_of(timer);
    if (latency_ms.empty()) {
      continue;
    }
    const std::string name = entry.path().filename();
    const std::string remedy = latency_ms == "1"
                                   ? ""
                                   : fmt::format(
                                         " (echo 1 | sudo tee "
                                         "/sys/bus/usb-serial/devices/{}/latency_timer)",
                                         name);
    found.push_back(fmt::format("{} {} ms{}", name, latency_ms, remedy));
  }
  return found.empty() ? "no adapter that waits" : fmt::format("{}", fmt::join(found, ", "));
}
}  // namespace

std::vector<std::pair<std::string, std::string>> machine_facts(const fs::path& root) {
  return {{"kernel", kernel()},
          {"clock", clock_source(root)},
          {"governor", governor(root)},
          {"isolated", isolated_processors(root)},
          {"idle", or_unknown(line_of(root / "sys/devices/system/cpu/cpuidle/current_driver"))},
          {"rt share", real_time_share(root)},
          {"rtprio", limit(RLIMIT_RTPRIO)},
          {"memlock", limit(RLIMIT_MEMLOCK)},
          {"usb irq", usb_interrupt_threads(root)},
          {"usb serial", usb_serial_latency(root)}};
}

namespace {
using Json = nlohmann::ordered_json;

constexpr double judged_share = 0.999;

// Beyond doubt, or not at all: one late tick says nothing about the ones to come.
Holds is_within(device::Nanoseconds limit, const device::LatenessCount& times) {
  const auto [low, high] = times.interval_of_quantile(judged_share);
  return low >= limit ? Holds::no : high && *high < limit ? Holds::yes : Holds::untold;
}

// The board's reply and the tick's own computation must fit into one period.
bool is_slow(const Diagnosis& diagnosis) {
  return diagnosis.round_trip &&
         is_within(diagnosis.period / 2, *diagnosis.round_trip) == Holds::no;
}

Json json_of(const device::LatenessCount& times) {
  const auto seconds = [](device::Nanoseconds time) { return 1e-9 * static_cast<double>(time); };
  const auto [low, high] = times.interval_of_quantile(judged_share);
  Json json{{"count", times.count()},
            {"p50_s", seconds(times.quantile(0.5))},
            {"p999_s", seconds(times.quantile(judged_share))},
            {"p999_low_s", seconds(low)},
            {"p999_high_s", high ? Json(seconds(*high)) : Json{}},
            {"worst_s", seconds(times.worst())}};
  return json;
}

Json json_of(const device::ProbedLoop& probed) {
  Json json = json_of(probed.lateness);
  json["late"] = probed.late;
  return json;
}
}  // namespace

device::Nanoseconds max_p999_lateness(device::Nanoseconds period) {
  return period / 4;
}

Diagnosis diagnose(const core::RealtimeRequest& request, device::Nanoseconds period, double seconds,
                   Under under, const std::function<void()>& exchange) {
  Diagnosis diagnosis;
  diagnosis.period = period;
  diagnosis.machine = machine_facts("/");
  diagnosis.idle = device::probe_loop(request, period, seconds);
  if (exchange) {
    diagnosis.on_device = device::probe_loop(request, period, seconds, exchange);
    diagnosis.round_trip = diagnosis.on_device->work;
  }
  if (under == Under::load_too) {
    const device::Load load;
    diagnosis.loaded = device::probe_loop(request, period, seconds);
  }
  return diagnosis;
}

Holds holds(const Diagnosis& diagnosis, const device::ProbedLoop& probed) {
  return is_within(max_p999_lateness(diagnosis.period), probed.lateness);
}

device::Nanoseconds max_p999_lateness(const device::ProbedCard& card) {
  return card.bridged() / 2;
}

Holds holds(const device::ProbedCard& card) {
  return card.gaps > 0 ? Holds::no : is_within(max_p999_lateness(card), card.lateness);
}

namespace {
Verdict verdict_of_loop(const Diagnosis& diagnosis) {
  const Holds idle = holds(diagnosis, diagnosis.idle);
  if (idle == Holds::no) {
    return {false, "this machine cannot hold the loop, even with nothing else to do"};
  }
  if (is_slow(diagnosis) ||
      (diagnosis.on_device && holds(diagnosis, *diagnosis.on_device) == Holds::no)) {
    return {false,
            "this machine holds the loop, but the device's reply takes more than half a period"};
  }
  if (idle == Holds::untold) {
    return {true, fmt::format("nothing speaks against this machine, but {} ticks are too few to "
                              "tell that it holds the loop",
                              diagnosis.idle.lateness.count())};
  }
  if (!diagnosis.loaded) {
    return {true, "this machine holds the loop with nothing else to do"};
  }
  return {true, holds(diagnosis, *diagnosis.loaded) == Holds::yes
                    ? "this machine holds the loop, under load too"
                    : "this machine holds the loop as long as nothing else runs on it: close "
                      "other programs during a session"};
}

Verdict verdict_of(const DiagnosedCard& card) {
  const Holds idle = holds(card.idle);
  if (idle == Holds::no) {
    return {false, "it cannot keep the actuator's card filled, even with nothing else to do"};
  }
  if (idle == Holds::untold) {
    return {true, fmt::format("{} periods are too few to tell that it keeps the actuator's card "
                              "filled",
                              card.idle.lateness.count())};
  }
  return {true, holds(card.loaded) == Holds::yes
                    ? "it keeps the actuator's card filled, under load too"
                    : "it keeps the actuator's card filled as long as nothing else runs on it"};
}
}  // namespace

Verdict verdict_of(const Diagnosis& diagnosis) {
  const Verdict loop = verdict_of_loop(diagnosis);
  if (!loop.holds || !diagnosis.actuator) {
    return loop;
  }
  const Verdict card = verdict_of(*diagnosis.actuator);
  return {card.holds, fmt::format("{}; {}", loop.words, card.words)};
}

std::string to_json(const Diagnosis& diagnosis) {
  Json json{{"rate_hz", 1e9 / static_cast<double>(diagnosis.period)},
            {"timer_slack_ns", diagnosis.idle.timer_slack_ns},
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
