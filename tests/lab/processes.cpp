#include "lab/processes.hpp"

#include <fmt/format.h>
#include <sys/syscall.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
namespace tapstudy::lab {
namespace {
// The number of the system call that a thread is in; -1: in none.
long system_call_of(const std::filesystem::path& thread) {
  std::ifstream file{thread / "syscall"};
  long number = -1;
  file >> number;
  return file ? number : -1;
}
}  // namespace

pid_t youngest_child(pid_t process) {
  std::ifstream children{fmt::format("/proc/{0}/task/{0}/children", process)};
  pid_t youngest = -1;
  while (children >> youngest) {
  }
  return youngest;
}

bool is_at_rest(pid_t process) {
  constexpr std::array busy{-1L,
                            long{SYS_read},
                            long{SYS_write},
                            long{SYS_recvfrom},
                            long{SYS_recvmsg},
                            long{SYS_sendto},
                            long{SYS_sendmsg},
                            long{SYS_ioctl}};
  return std::ranges::none_of(
      std::filesystem::directory_iterator{fmt::format("/proc/{}/task", process)},
      [&](const auto& thread) {
        return std::ranges::find(busy, system_call_of(thread.path())) != busy.end();
      });
}
}  // namespace tapstudy::lab
