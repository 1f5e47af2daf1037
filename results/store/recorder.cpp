#include "results/store/recorder.hpp"

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

// Any exception goes to whoever waits for what was written.
template <class Act>
auto Recorder::queue(Act act, HasTrace has_trace) -> std::future<decltype(act())> {
  auto task = std::make_shared<std::packaged_task<decltype(act())(std::exception_ptr)>>(
      [act = std::move(act)](const std::exception_ptr& drain_failure) {
        if (drain_failure) {
          std::rethrow_exception(drain_failure);
        }
        return act();
      });
  {
    const std::lock_guard lock{mutex_};
    pending_.push_back(
        {[task](std::exception_ptr drain_failure) { (*task)(std::move(drain_failure)); },
         has_trace});
  }
  arrived_.notify_all();
  return task->get_future();
}

std::future<SaveOutcome> Recorder::save(std::shared_ptr<const TrialRecord> record) {
  return queue(
      [this, record = std::move(record)] {
        store_events();
        return store_.add_trial(*record);
      },
      HasTrace::yes);
}

std::future<void> Recorder::note(std::vector<SessionEventRow> events) {
  return queue([this, events = std::move(events)] {
    events_.insert(events_.end(), events.begin(), events.end());
    store_events();
  });
}

void Recorder::store_events() {
  if (!events_.empty()) {
    store_.add_session_events(events_);
    events_.clear();
  }
}

std::future<void> Recorder::note(OperatorActionRow action) {
  return queue([this, action = std::move(action)] { store_.add_operator_action(action); });
}

std::future<void> Recorder::save_form(std::vector<FormAnswerRow> answers) {
  return queue([this, answers = std::move(answers)] { store_.add_form(answers); });
}

std::future<void> Recorder::correct(CorrectionRow correction, OperatorActionRow action) {
  return queue([this, correction = std::move(correction), action = std::move(action)] {
    store_.add_correction(correction, action);
  });
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
      write.act(write.has_trace == HasTrace::yes ? std::exchange(drain_failure_, nullptr)
                                                 : nullptr);
      lock.lock();
    }
  }
}
}  // namespace tapstudy::results
