#pragma once
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
namespace tapstudy::runner {
// Says on stderr what takes long: nothing in the first second, then what and for how long.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress& other) = delete;
  Progress& operator=(const Progress& other) = delete;

 private:
  void talk(const std::stop_token& stop);
  std::string what_;
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};
}  // namespace tapstudy::runner
