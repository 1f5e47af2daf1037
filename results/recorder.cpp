#include "results/recorder.hpp"

#include <chrono>
#include <exception>
#include <utility>
namespace tapstudy::results {
namespace {
constexpr std::chrono::milliseconds drain_every{5};
}

Recorder::Recorder(Store& store)
    : store_{store}, thread_{[this](const std::stop_token& stop) { run(stop); }} {}

Recorder::~Recorder() {
  thread_.request_stop();
  arrived_.notify_all();
}

std::future<void> Recorder::save(TrialRecord record) {
  PendingTrial trial{std::move(record), {}};
  std::future<void> saved = trial.saved.get_future();
  {
    const std::lock_guard lock{mutex_};
    pending_.push_back(std::move(trial));
  }
  arrived_.notify_all();
  return saved;
}

void Recorder::follow(TraceCollector& collector) {
  const std::lock_guard lock{mutex_};
  followed_ = &collector;
}

void Recorder::leave() {
  const std::lock_guard lock{mutex_};
  followed_ = nullptr;
}

void Recorder::write(PendingTrial& trial) {
  try {
    if (drain_failure_) {
      std::rethrow_exception(std::exchange(drain_failure_, nullptr));
    }
    store_.add_trial(trial.record);
    trial.saved.set_value();
  } catch (...) {  // any exception goes to whoever waits for the trial
    trial.saved.set_exception(std::current_exception());
  }
}

void Recorder::drain_followed() noexcept {
  try {
    if (followed_ != nullptr) {
      followed_->drain();
    }
  } catch (...) {  // delivered through the trial's promise
    drain_failure_ = std::current_exception();
    followed_ = nullptr;
  }
}

void Recorder::run(const std::stop_token& stop) {
  std::unique_lock lock{mutex_};
  while (!stop.stop_requested() || !pending_.empty()) {
    arrived_.wait_for(lock, stop, drain_every, [this] { return !pending_.empty(); });
    drain_followed();
    while (!pending_.empty()) {
      PendingTrial trial = std::move(pending_.front());
      pending_.pop_front();
      lock.unlock();
      write(trial);
      lock.lock();
    }
  }
}
}  // namespace tapstudy::results
