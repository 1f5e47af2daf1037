#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "core/model/progress_hook.hpp"
namespace tapstudy::runner {
// Progress messages on stderr: none in the first second, then the activity and elapsed time.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress& other) = delete;
  Progress& operator=(const Progress& other) = delete;

  // Receives the stages of a computation, and cancels it if the operator asked to stop.
  core::ProgressHook hook();

 private:
  void talk(const std::stop_token& stop);
  std::string what_;
  std::mutex mutex_;
  std::string stage_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};
}  // namespace tapstudy::runner
