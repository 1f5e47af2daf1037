#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "core/model/progress_hook.hpp"
namespace tapstudy::runner {
// Says on stderr what takes long: nothing in the first second, then what and for how long.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress& other) = delete;
  Progress& operator=(const Progress& other) = delete;

  // Takes over what a computation says of its stages, and stops it where the operator asked to.
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
