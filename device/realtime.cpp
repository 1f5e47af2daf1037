#include "device/realtime.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
namespace tapstudy::device {
namespace {
std::string scheduler(int priority) {
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
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0
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
}  // namespace

std::string ask_for_realtime(const RealtimeRequest& request) {
  return fmt::format("{}; {}; {}", scheduler(request.fifo_priority), memory(request.lock_memory),
                     processor(request.cpu));
}
}  // namespace tapstudy::device
