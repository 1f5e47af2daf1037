#pragma once
#include <memory>
#include <string>

#include "core/model/progress.hpp"
namespace tapstudy::runner {
// Log lines go to stderr, results to stdout; never the other way round.
void set_up_logging();
void warn(const std::string& what);

// "12 of 200, about 34 s left", at the pace so far.
std::string describe_count(std::size_t done, std::size_t all, double elapsed_s);

// Progress messages on stderr: none in the first second, then the activity and elapsed time. What
// begins while another one talks is a stage of that one, so that there is one line at a time.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress& other) = delete;
  Progress& operator=(const Progress& other) = delete;

  // Receives the stages of a computation, and cancels it if the operator asked to stop.
  core::ProgressHook hook();
  // Receives how many of its parts are done, and cancels it likewise. May be called by any thread.
  core::CountHook count();

 private:
  class Speaker;
  std::shared_ptr<Speaker> speaker_;
  std::string prefix_;  // of its stages; empty for the one that talks
};
}  // namespace tapstudy::runner
