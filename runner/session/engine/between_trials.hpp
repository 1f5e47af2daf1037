#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "protocols/protocol.hpp"
#include "protocols/schedule/schedule.hpp"
#include "results/journal/journal.hpp"
#include "results/rows.hpp"
#include "runner/session/engine/practice.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/participants/participant.hpp"
namespace tapstudy::runner {
using FilledForms = std::set<std::pair<std::string, std::string>>;  // form, where it was asked

// What a participant has answered in earlier sessions that a new one depends on.
struct EarlierAnswers {
  FilledForms filled_forms{};
  PracticeRecord practice{};
  std::vector<results::JournalledAnswer> as_given{};  // in that order
  std::map<int, int> attempts{};                      // of each trial, by its number
  std::vector<int> requeued{};                        // trials to come again, the last one last
};

// Where forms are asked that come after no block; no block can have these names.
inline constexpr const char* asked_at_begin = "session begin";
inline constexpr const char* asked_at_end = "session end";

// Between these two blocks. A block's own instructions say by themselves what counts.
bool is_end_of_practice_said(const protocols::Block& before, const protocols::Block& block);

// What comes between the trials of a session: instructions, rests, and questionnaires.
class BetweenTrials {
 public:
  struct Parts {
    const protocols::Protocol& protocol;
    Participant& participant;
    SessionStates& states;
    // Returns once the answers are stored; session and time are filled in.
    std::function<void(std::vector<results::FormAnswerRow>)> save_form;
    std::function<void()> wait_while_paused;
  };
  // filled: those answered in an earlier session.
  BetweenTrials(Parts parts, FilledForms filled)
      : parts_{std::move(parts)}, filled_{std::move(filled)} {}
  // Both throw Stopped if the participant stops.
  void before(const protocols::PlannedTrial& trial, const protocols::Schedule& schedule);
  void after_last_trial(const protocols::Schedule& schedule);

 private:
  void begin(bool has_trials);
  // nullopt: after all blocks.
  void ask_after_blocks(const protocols::Schedule& schedule,
                        const std::optional<std::string>& up_to);
  void read(const std::string& text, const std::string& whose);
  void introduce(const protocols::Block& block);
  void rest_if_due(const protocols::Block& block);
  void ask(const std::vector<std::string>& forms, const std::string& asked);
  Parts parts_;
  FilledForms filled_;
  bool has_begun_{false};
  std::optional<std::string> block_;
  int trials_since_rest_{0};
  double rested_at_s_{0.0};  // or the block's begin
};
}  // namespace tapstudy::runner
