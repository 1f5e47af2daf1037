#include "runner/terminal/progress.hpp"

#include <spdlog/spdlog.h>

#include <chrono>

#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
Progress::Progress(std::string what)
    : what_{std::move(what)}, thread_{[this](const std::stop_token& stop) { talk(stop); }} {}

Progress::~Progress() {
  thread_.request_stop();
  ended_.notify_all();
}

core::ProgressHook Progress::hook() {
  return [this](std::string_view stage) {
    {
      const std::lock_guard lock{mutex_};
      stage_ = stage;
    }
    stop_if_asked();
  };
}

void Progress::talk(const std::stop_token& stop) {
  std::unique_lock lock{mutex_};
  int seconds = 0;
  int next = 1;
  while (!ended_.wait_for(lock, stop, std::chrono::seconds{next - seconds},
                          [&] { return stop.stop_requested(); })) {
    seconds = next;
    next += 5;
    spdlog::info("{} … {} s{}{}{}", what_, seconds, stage_.empty() ? "" : ", ", stage_,
                 stop_was_asked() ? ", stopping after this step (Ctrl-C again: at once)" : "");
  }
}
}  // namespace tapstudy::runner
