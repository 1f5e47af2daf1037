#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "results/store/store.hpp"
#include "results/traces/trace_collector.hpp"
namespace tapstudy::results {
// The only thread that writes to the store. During a live trial it also drains the haptic thread's
// ring, so that the loop never waits for the disk.
class Recorder {
 public:
  explicit Recorder(Store& store);
  ~Recorder();  // finishes pending saves, then stops
  Recorder(const Recorder& other) = delete;
  Recorder& operator=(const Recorder& other) = delete;

  // Ready once the trial is stored (store.hpp); carries the StoreError on failure, after which the
  // same record may be saved again.
  std::future<SaveOutcome> save(std::shared_ptr<const TrialRecord> record);

  // Ready once the events are stored, or carries the StoreError: they are kept then, and stored
  // with the next events or the next trial, whose save fails otherwise.
  std::future<void> note(std::vector<SessionEventRow> events);
  std::future<void> note(OperatorActionRow action);
  std::future<void> save_form(std::vector<FormAnswerRow> answers);
  std::future<void> correct(CorrectionRow correction, OperatorActionRow action);

  // Drains the collector every few milliseconds, until leave() returns. If draining fails, the loop
  // continues, dropped samples are counted, and saving the trial fails with the cause.
  void follow(TraceCollector& collector);
  void leave();

 private:
  void run(const std::stop_token& stop);
  enum class HasTrace { no, yes };  // what could not be drained is missing in it
  struct Write {
    std::function<void(std::exception_ptr drain_failure)> act;
    HasTrace has_trace{};
  };
  template <class Act>
  auto queue(Act act, HasTrace has_trace = HasTrace::no) -> std::future<decltype(act())>;
  void drain_followed() noexcept;
  void store_events();

  Store& store_;
  std::vector<SessionEventRow> events_;  // not stored yet; of the recorder's thread
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::deque<Write> pending_;
  TraceCollector* followed_{nullptr};
  std::exception_ptr drain_failure_;  // passed to the next trial's write
  std::jthread thread_;
};
}  // namespace tapstudy::results
