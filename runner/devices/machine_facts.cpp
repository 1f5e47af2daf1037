#include "runner/devices/machine_facts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/utsname.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
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
  return {
      {"kernel", kernel()},
      {"clock", clock_source()},
      {"governor", or_unknown(line_of("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor"))},
      {"idle", or_unknown(line_of("/sys/devices/system/cpu/cpuidle/current_driver"))},
      {"rt share", real_time_share()},
      {"rtprio", limit(RLIMIT_RTPRIO)},
      {"memlock", limit(RLIMIT_MEMLOCK)},
      {"usb irq", usb_interrupt_threads()}};
}
}  // namespace tapstudy::runner
