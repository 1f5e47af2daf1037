#include "device/loop/realtime.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
namespace tapstudy::device {
namespace {
using Refusals = std::vector<GrantedRealtime::Refusal>;

constexpr const char* limits_remedy =
    "printf '%s - rtprio 99\\n%s - memlock unlimited\\n' $USER $USER | sudo tee "
    "/etc/security/limits.d/90-tapstudy.conf, and log in again";

// Without real-time priority the kernel may wake a thread late by its timer slack, default 50 us.
std::string scheduler(int priority, Refusals& refusals) {
  prctl(PR_SET_TIMERSLACK, 1UL);  // NOLINT(cppcoreguidelines-pro-type-vararg): the C library's own
  if (priority <= 0) {
    return "SCHED_OTHER";
  }
  const sched_param parameters{priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) {
    return fmt::format("SCHED_FIFO {}", priority);
  }
  refusals.push_back({"real-time priority", limits_remedy});
  return fmt::format("SCHED_OTHER (SCHED_FIFO refused: {})", std::strerror(error));
}

std::string memory(bool is_asked, Refusals& refusals) {
  if (!is_asked) {
    return "memory not locked";
  }
  // where locked memory is limited, MCL_FUTURE would make later allocations fail
  rlimit limit{};
  const bool is_unlimited =
      getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (mlockall(is_unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT | MCL_ONFAULT) == 0) {
    return "memory locked";
  }
  const int error = errno;
  refusals.push_back({"locked memory", limits_remedy});
  return fmt::format("memory not locked ({})", std::strerror(error));
}

std::string processor(std::optional<int> cpu, Refusals& refusals) {
  if (!cpu) {
    return "any processor";
  }
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(*cpu), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  if (error == 0) {
    return fmt::format("processor {}", *cpu);
  }
  refusals.push_back({fmt::format("processor {}", *cpu), "another one for loop.cpu in the rig"});
  return fmt::format("any processor ({} refused: {})", *cpu, std::strerror(error));
}

// Deep CPU idle states have a long wake-up latency. The kernel avoids them while the file is open:
// until this process ends.
std::string sleep_of_processors(int priority, Refusals& refusals) {
  if (priority <= 0) {
    return "processors may sleep";
  }
  static const bool are_kept_awake = [] {
    constexpr std::int32_t max_wake_latency_us = 0;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
    const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    return file >= 0 && write(file, &max_wake_latency_us, sizeof max_wake_latency_us) ==
                            sizeof max_wake_latency_us;
  }();
  if (are_kept_awake) {
    return "processors kept awake";
  }
  refusals.push_back({"keeping processors awake",
                      "sudo setfacl -m u:$USER:rw /dev/cpu_dma_latency, until the next boot"});
  return "processors may sleep";
}
}  // namespace

GrantedRealtime ask_for_realtime(const core::RealtimeRequest& request) {
  GrantedRealtime granted;
  Refusals& refusals = granted.refusals;
  const std::string scheduling = scheduler(request.fifo_priority, refusals);
  const std::string locking = memory(request.lock_memory, refusals);
  const std::string placing = processor(request.cpu, refusals);
  granted.text = fmt::format("{}; {}; {}; {}", scheduling, locking, placing,
                             sleep_of_processors(request.fifo_priority, refusals));
  return granted;
}
}  // namespace tapstudy::device
