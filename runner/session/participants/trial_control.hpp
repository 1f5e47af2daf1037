#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "results/rows.hpp"
#include "runner/session/participants/trial_rules.hpp"
#include "runner/session/trial_loop/exploration.hpp"
namespace tapstudy::runner {
// Events of a trial that are not found in its trace: kept, and told as they happen.
class TrialEvents {
 public:
  using Tell = std::function<void(const results::EventRow&)>;
  explicit TrialEvents(Tell tell = {}) : tell_{std::move(tell)} {}
  void add(results::EventRow event) {
    rows_.push_back(std::move(event));
    if (tell_) {
      tell_(rows_.back());
    }
  }
  const std::vector<results::EventRow>& rows() const { return rows_; }

 private:
  Tell tell_;
  std::vector<results::EventRow> rows_;
};

// The operator's way to end a running trial.
enum class TrialRequest { repeat, skip };

// Everything that the operator wants of a running trial at one moment.
struct OperatorRequests {
  std::optional<std::size_t> switch_to{};  // an alternative
  std::optional<TrialRequest> end{};
  bool is_paused{};
  bool is_end_wanted() const { return is_paused || end.has_value(); }
};

// The others that take part in a trial; each function may be empty.
struct TrialLinks {
  std::function<OperatorRequests()> take_requests{};  // the switch is taken, and not given again
  std::function<void(std::size_t alternative)> alternative_is_selected{};
  std::function<void(const std::string& answer)> answer_is_entered{};  // empty: withdrawn
};

// One trial while it is explored: it carries out what the participant and the operator ask for, as
// far as the trial's rules allow, and keeps what they entered.
class TrialControl {
 public:
  // The loop and the events must outlive it.
  TrialControl(Exploration& loop, TrialRules rules, TrialEvents& events, TrialLinks links = {});

  // For the participant, who calls poll continually: it carries out the operator's requests, lets
  // intervals begin and end, and returns whether the trial goes on.
  bool poll();
  // Lets the trial go on; returns early if its time is over or a fault has ended it.
  void pass_time(double seconds);
  double time_s() const { return loop_.time_s(); }  // since the trial began
  // Has no effect where the alternatives come one after the other.
  void switch_to(std::size_t alternative);
  std::size_t current() const { return current_; }
  // Sets the last alternative, where it has settings, to one of them, from 0, and switches to it.
  void adjust(std::size_t setting);
  std::size_t setting() const { return setting_; }
  // nullptr: alternatives are switched freely.
  const IntervalState* intervals() const { return sequence_ ? &sequence_->state() : nullptr; }
  // All intervals once more, where the last is over and replays are left.
  void replay();
  // An answer that may still be changed; empty: it was withdrawn.
  void enter_answer(const std::string& answer);
  // The number of times that the finger has come down on an alternative, as it is set.
  int contacts(std::size_t alternative) const;

  // For the engine.
  bool is_loop_running();
  bool is_rendering() const { return loop_.is_rendering(); }
  bool is_time_over() const { return rules_.is_time_over(time_s()); }
  Explored explored() const;
  // The requests that ended the trial, whatever the operator wants since.
  const std::optional<OperatorRequests>& ended_by_operator() const { return ended_by_operator_; }

 private:
  void take_requests();
  void follow_intervals();
  void render(std::size_t alternative);
  void note_setting();

  Exploration& loop_;
  TrialRules rules_;
  TrialEvents& events_;
  TrialLinks links_;
  std::size_t current_{0};
  std::size_t setting_{0};
  std::optional<IntervalSequence> sequence_;
  std::string entered_;
  std::size_t told_{0};  // the alternative that the operator knows of
  std::optional<OperatorRequests> ended_by_operator_;
};
}  // namespace tapstudy::runner
