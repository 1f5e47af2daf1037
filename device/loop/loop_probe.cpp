#include "device/loop/loop_probe.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
namespace {
constexpr std::size_t bytes_at_once = 1 << 20;
constexpr int writes_before_rewind = 16;

void compute(const std::stop_token& stop) {
  volatile double sink = 1.0;
  while (!stop.stop_requested()) {
    for (int i = 0; i < 10'000; ++i) {
      sink = std::sqrt(sink + 1.0);
    }
  }
}

// Like the recorder, but heavier: each block is synced to disk before the next.
void write_to_disk(const std::stop_token& stop) {
  std::string name{"/tmp/tapstudy_doctor_XXXXXX"};
  const int file = mkstemp(name.data());
  if (file < 0) {
    return;
  }
  unlink(name.c_str());
  const std::vector<char> bytes(bytes_at_once, 'x');
  for (int i = 1; !stop.stop_requested(); ++i) {
    if (write(file, bytes.data(), bytes.size()) < 0 || fdatasync(file) != 0 ||
        (i % writes_before_rewind == 0 && lseek(file, 0, SEEK_SET) != 0)) {
      break;
    }
  }
  close(file);
}

void run_probe(const core::RealtimeRequest& request, Nanoseconds period, std::int64_t ticks,
               const std::function<void()>& work, ProbedLoop& probed) {
  probed.realtime = ask_for_realtime(request);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the C library's own
  probed.timer_slack_ns = prctl(PR_GET_TIMERSLACK);
  MonotonicClock clock;
  Nanoseconds deadline = clock.now();
  for (std::int64_t i = 0; i < ticks; ++i) {
    deadline += period;
    const Nanoseconds woke_at = clock.wait_until(deadline);
    const Nanoseconds lateness = woke_at - deadline;
    probed.lateness.add(lateness);
    probed.late += lateness > period / 2 ? 1 : 0;
    deadline += lateness / period * period;
    if (work) {
      work();
      probed.work.add(clock.now() - woke_at);
    }
  }
}
}  // namespace

ProbedLoop probe_loop(const core::RealtimeRequest& request, Nanoseconds period, double seconds,
                      const std::function<void()>& work) {
  ProbedLoop probed;
  std::exception_ptr failure;
  const auto ticks =
      static_cast<std::int64_t>(std::llround(1e9 * seconds / static_cast<double>(period)));
  std::jthread{[&] {
    try {
      run_probe(request, period, ticks, work, probed);
    } catch (...) {
      failure = std::current_exception();
    }
  }}.join();
  if (failure) {
    std::rethrow_exception(failure);
  }
  return probed;
}

struct Load::Workers {
  std::vector<std::jthread> threads;
};

Load::Load() : workers_{std::make_unique<Workers>()} {
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < processors; ++i) {
    workers_->threads.emplace_back(compute);
  }
  workers_->threads.emplace_back(write_to_disk);
}

Load::~Load() = default;
}  // namespace tapstudy::device
