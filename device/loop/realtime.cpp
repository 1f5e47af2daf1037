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
// Without real-time priority the kernel may wake a thread late by its timer slack, default 50 us.
std::string scheduler(int priority) {
  prctl(PR_SET_TIMERSLACK, 1UL);  // NOLINT(cppcoreguidelines-pro-type-vararg): the C library's own
  if (priority <= 0) {
    return "SCHED_OTHER";
  }
  const sched_param parameters{priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  return error == 0 ? fmt::format("SCHED_FIFO {}", priority)
                    : fmt::format("SCHED_OTHER (SCHED_FIFO refused: {})", std::strerror(error));
}

std::string memory(bool is_asked) {
  if (!is_asked) {
    return "memory not locked";
  }
  // where locked memory is limited, MCL_FUTURE would make later allocations fail
  rlimit limit{};
  const bool is_unlimited =
      getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  return mlockall(is_unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT | MCL_ONFAULT) == 0
             ? "memory locked"
             : fmt::format("memory not locked ({})", std::strerror(errno));
}

std::string processor(std::optional<int> cpu) {
  if (!cpu) {
    return "any processor";
  }
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(*cpu), &set);
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  return error == 0 ? fmt::format("processor {}", *cpu)
                    : fmt::format("any processor ({} refused: {})", *cpu, std::strerror(error));
}

// Deep CPU idle states have a long wake-up latency. The kernel avoids them while the file is open:
// until this process ends.
std::string sleep_of_processors(int priority) {
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
  return are_kept_awake ? "processors kept awake" : "processors may sleep";
}
}  // namespace

std::string ask_for_realtime(const core::RealtimeRequest& request) {
  return fmt::format("{}; {}; {}; {}", scheduler(request.fifo_priority),
                     memory(request.lock_memory), processor(request.cpu),
                     sleep_of_processors(request.fifo_priority));
}
}  // namespace tapstudy::device
