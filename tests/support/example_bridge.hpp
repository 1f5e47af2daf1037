#pragma once
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <string>

#include "support/built_paths.hpp"
#include "support/catch.hpp"

extern char** environ;
namespace tapstudy::testing {
// The example that ships, as a program of its own.
class ExampleBridge {
 public:
  explicit ExampleBridge(std::uint16_t port) {
    std::string program{bridge_program()};
    std::string number = std::to_string(port);
    const std::array<char*, 3> words{program.data(), number.data(), nullptr};
    REQUIRE(posix_spawn(&child_, program.c_str(), nullptr, nullptr, words.data(), environ) == 0);
  }
  ~ExampleBridge() { end(); }
  ExampleBridge(const ExampleBridge&) = delete;
  ExampleBridge& operator=(const ExampleBridge&) = delete;
  ExampleBridge(ExampleBridge&&) = delete;
  ExampleBridge& operator=(ExampleBridge&&) = delete;
  void end() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
      child_ = -1;
    }
  }

 private:
  pid_t child_{-1};
};

// Apart for every process, so that tests may run beside each other.
inline std::uint16_t free_port() {
  return static_cast<std::uint16_t>(40000 + getpid() % 20000);
}
}  // namespace tapstudy::testing
