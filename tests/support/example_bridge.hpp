#pragma once
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "support/built_paths.hpp"
#include "support/catch.hpp"

extern char** environ;
namespace tapstudy::testing {
// An example that ships, as a program of its own.
class ExampleBridge {
 public:
  // command: the program, and its arguments after the port.
  explicit ExampleBridge(std::uint16_t port,
                         std::vector<std::string> command = {bridge_program()}) {
    command.insert(command.begin() + 1, std::to_string(port));
    std::vector<char*> words;
    for (std::string& word : command) {
      words.push_back(word.data());
    }
    words.push_back(nullptr);
    REQUIRE(posix_spawn(&child_, words.front(), nullptr, nullptr, words.data(), environ) == 0);
    // It lets go after 20 ms of real time without a request: where that is allowed, it does not
    // wait for a processor behind other tests.
    const sched_param first{1};
    sched_setscheduler(child_, SCHED_FIFO, &first);
  }
  ~ExampleBridge() { end(); }
  ExampleBridge(const ExampleBridge&) = delete;
  ExampleBridge& operator=(const ExampleBridge&) = delete;
  ExampleBridge(ExampleBridge&&) = delete;
  ExampleBridge& operator=(ExampleBridge&&) = delete;
  void end(int signal = SIGKILL) {
    if (child_ > 0) {
      kill(child_, signal);
      waitpid(child_, nullptr, 0);
      child_ = -1;
    }
  }
  // Until it is told to go on.
  void stop() {
    kill(child_, SIGSTOP);
    int status = 0;
    while (waitpid(child_, &status, WUNTRACED) == child_ && !WIFSTOPPED(status)) {
    }
  }
  void go_on() { kill(child_, SIGCONT); }
  // Of one that ends by itself.
  int exit_code() {
    int status = 0;
    waitpid(std::exchange(child_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t child_{-1};
};

// Examples run in real time: a machine that is busy elsewhere may keep either program from it for
// long, but a reply comes in the end.
inline constexpr std::chrono::milliseconds unhurried{20'000};

// Apart for every process, so that tests may run beside each other, and below those that Linux
// gives to sockets that ask for none (ip_local_port_range, from 32768).
inline std::uint16_t free_port() {
  return static_cast<std::uint16_t>(10000 + getpid() % 20000);
}
}  // namespace tapstudy::testing
