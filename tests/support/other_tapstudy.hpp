#pragma once
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <thread>

#include "device/remote/remote_hand.hpp"
#include "support/catch.hpp"
#include "support/example_bridge.hpp"
namespace tapstudy::testing {
constexpr double max_sample_age_s = 1.0;  // a busy machine may keep anybody from the processor

// However long it takes.
template <class Condition>
void wait_until(const Condition& is_so) {
  while (!is_so()) {
    std::this_thread::sleep_for(std::chrono::microseconds{200});
  }
}

// One tick. elapsed_s is what the checks are told, shorter than any tick here takes. After a fault
// the next trial begins.
inline core::TickFault press(device::RemoteHand& hand, double force_n, double elapsed_s = 1e-5) {
  core::HandState state;
  core::TickFault fault = hand.write({0.0, force_n, 0.0});
  fault = fault == core::TickFault::none ? hand.read(state, elapsed_s) : fault;
  if (fault != core::TickFault::none) {
    static_cast<void>(hand.begin());
  }
  return fault;
}

// Another tapstudy, a process of its own, which presses whatever it is told, until it is killed.
class OtherTapstudy {
 public:
  OtherTapstudy(std::uint16_t port, double force_n) : child_{fork()} {
    if (child_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      device::RemoteHand hand{port, {unhurried, max_sample_age_s}};
      while (true) {
        static_cast<void>(press(hand, force_n));
      }
    }
  }
  ~OtherTapstudy() { end(); }
  OtherTapstudy(const OtherTapstudy&) = delete;
  OtherTapstudy& operator=(const OtherTapstudy&) = delete;
  OtherTapstudy(OtherTapstudy&&) = delete;
  OtherTapstudy& operator=(OtherTapstudy&&) = delete;
  void end() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
      child_ = -1;
    }
  }
  void stop() {
    int status = 0;
    kill(child_, SIGSTOP);
    REQUIRE(waitpid(child_, &status, WUNTRACED) == child_);
    REQUIRE(WIFSTOPPED(status));
  }
  void go_on() { kill(child_, SIGCONT); }

 private:
  pid_t child_;
};
}  // namespace tapstudy::testing
