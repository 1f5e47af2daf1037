#include "results/recorder.hpp"

#include <chrono>
#include <exception>
#include <type_traits>
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

namespace {
// Any exception goes to whoever waits for what was written.
template <class Result, class Act>
auto promised(std::shared_ptr<std::promise<Result>> promise, Act act) {
  return [promise = std::move(promise), act = std::move(act)](std::exception_ptr drain_failure) {
    try {
      if (drain_failure) {
        std::rethrow_exception(drain_failure);
      }
      if constexpr (std::is_void_v<Result>) {
        act();
        promise->set_value();
      } else {
        promise->set_value(act());
      }
    } catch (...) {
      promise->set_exception(std::current_exception());
    }
  };
}
}  // namespace

void Recorder::queue(Write write) {
  {
    const std::lock_guard lock{mutex_};
    pending_.push_back(std::move(write));
  }
  arrived_.notify_all();
}

std::future<SaveOutcome> Recorder::save(std::shared_ptr<const TrialRecord> record) {
  auto promise = std::make_shared<std::promise<SaveOutcome>>();
  queue(
      {promised(promise, [this, record = std::move(record)] { return store_.add_trial(*record); }),
       true});
  return promise->get_future();
}

std::future<void> Recorder::note(std::vector<SessionEventRow> events) {
  auto promise = std::make_shared<std::promise<void>>();
  queue(
      {promised(promise, [this, events = std::move(events)] { store_.add_session_events(events); }),
       false});
  return promise->get_future();
}

std::future<void> Recorder::note(OperatorActionRow action) {
  auto promise = std::make_shared<std::promise<void>>();
  queue({promised(promise,
                  [this, action = std::move(action)] { store_.add_operator_action(action); }),
         false});
  return promise->get_future();
}

std::future<void> Recorder::save_form(std::vector<FormAnswerRow> answers) {
  auto promise = std::make_shared<std::promise<void>>();
  queue({promised(promise, [this, answers = std::move(answers)] { store_.add_form(answers); }),
         false});
  return promise->get_future();
}

std::future<void> Recorder::correct(CorrectionRow correction, OperatorActionRow action) {
  auto promise = std::make_shared<std::promise<void>>();
  queue({promised(promise,
                  [this, correction = std::move(correction), action = std::move(action)] {
                    store_.add_correction(correction, action);
                  }),
         false});
  return promise->get_future();
}

void Recorder::follow(TraceCollector& collector) {
  const std::lock_guard lock{mutex_};
  followed_ = &collector;
}

void Recorder::leave() {
  const std::lock_guard lock{mutex_};
  followed_ = nullptr;
}

void Recorder::drain_followed() noexcept {
  try {
    if (followed_ != nullptr) {
      followed_->drain();
    }
  } catch (...) {  // delivered with the trial
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
      const Write write = std::move(pending_.front());
      pending_.pop_front();
      lock.unlock();
      write.act(write.is_trial ? std::exchange(drain_failure_, nullptr) : nullptr);
      lock.lock();
    }
  }
}
}  // namespace tapstudy::results
