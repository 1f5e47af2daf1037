#pragma once
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <stop_token>
#include <thread>

#include "results/store.hpp"
#include "results/trace_collector.hpp"
namespace tapstudy::results {
// The only thread that writes to the store. During a live trial it also drains the haptic thread's
// ring, so that the loop never waits for the disk.
class Recorder {
 public:
  explicit Recorder(Store& store);
  ~Recorder();  // finishes pending saves, then stops
  Recorder(const Recorder& other) = delete;
  Recorder& operator=(const Recorder& other) = delete;

  // Ready once the trial is committed to the database; carries the StoreError on failure.
  std::future<void> save(TrialRecord record);

  // Drains the collector every few milliseconds, until leave() returns. If draining fails, the loop
  // continues, dropped samples are counted, and saving the trial fails with the cause.
  void follow(TraceCollector& collector);
  void leave();

 private:
  void run(const std::stop_token& stop);
  struct PendingTrial {
    TrialRecord record;
    std::promise<void> saved;
  };
  void write(PendingTrial& trial);
  void drain_followed() noexcept;

  Store& store_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<PendingTrial> pending_;
  TraceCollector* followed_{nullptr};
  std::exception_ptr drain_failure_;  // rethrown when the next trial is saved
  std::jthread thread_;
};
}  // namespace tapstudy::results
