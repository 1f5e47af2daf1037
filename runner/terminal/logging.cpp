#include "runner/terminal/logging.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
void set_up_logging() {
  auto logger = spdlog::stderr_color_mt("tapstudy");
  logger->set_pattern("tapstudy: %^%v%$");
  spdlog::set_default_logger(logger);
}

void warn(const std::string& what) {
  spdlog::warn("{}", what);
}

std::string describe_count(std::size_t done, std::size_t all, double elapsed_s) {
  const double left_s = elapsed_s * static_cast<double>(all - done) /
                        static_cast<double>(std::max<std::size_t>(done, 1));
  return fmt::format(
      "{} of {}{}", done, all,
      done > 0 && done < all ? fmt::format(", about {:.0f} s left", std::ceil(left_s)) : "");
}

class Progress::Speaker {
 public:
  explicit Speaker(std::string what)
      : what_{std::move(what)}, thread_{[this](const std::stop_token& stop) { talk(stop); }} {}

  // The one that talks already, or a new one.
  static std::pair<std::shared_ptr<Speaker>, bool> now(const std::string& what) {
    static std::mutex mutex;
    static std::weak_ptr<Speaker> talking;
    const std::lock_guard lock{mutex};
    if (auto speaker = talking.lock()) {
      return {speaker, false};
    }
    auto speaker = std::make_shared<Speaker>(what);
    talking = speaker;
    return {speaker, true};
  }

  void set(std::string stage) {
    const std::lock_guard lock{mutex_};
    stage_ = std::move(stage);
  }

 private:
  void talk(const std::stop_token& stop) {
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

  std::string what_;
  std::mutex mutex_;
  std::string stage_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};

Progress::Progress(std::string what) {
  const auto [speaker, is_new] = Speaker::now(what);
  speaker_ = speaker;
  if (!is_new) {
    speaker_->set(what);
    prefix_ = std::move(what);
  }
}

Progress::~Progress() {
  if (!prefix_.empty()) {
    speaker_->set({});
  }
}

core::ProgressHook Progress::hook() {
  return [this](std::string_view stage) {
    speaker_->set(prefix_.empty() ? std::string{stage} : fmt::format("{}, {}", prefix_, stage));
    stop_if_asked();
  };
}

core::CountHook Progress::count() {
  return [tell = hook(), time = core::Stopwatch{}](std::size_t done, std::size_t all) {
    tell(describe_count(done, all, time.elapsed_s()));
  };
}
}  // namespace tapstudy::runner
