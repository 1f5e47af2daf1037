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
// What a participant has answered in earlier sessions that a new one depends on.
struct EarlierAnswers {
  std::vector<results::FormAnswerRow> forms{};
  PracticeRecord practice{};
  std::vector<results::JournalledAnswer> as_given{};  // in that order
  std::map<int, int> attempts{};                      // of each trial, by its number
  std::vector<int> requeued{};                        // trials to come again, the last one last
  bool comes_again{false};  // for another session: the study's last forms are asked then
};

// Where forms are asked that come after no block; no block can have these names.
inline constexpr const char* asked_at_begin = "session begin";
inline constexpr const char* asked_at_end = "session end";

// Of a form that was asked more than once, the latest.
protocols::FilledForms filled_forms(const std::vector<results::FormAnswerRow>& answers);
// Of these what was answered before the first trial, which decides what is presented.
protocols::FilledForms filled_before(const std::vector<results::FormAnswerRow>& answers);
// "no to 'agree' of form 'consent'": the answer that ended the participant's part in the study.
std::optional<std::string> ending_answer(const protocols::Protocol& protocol,
                                         const std::vector<results::FormAnswerRow>& answers);

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
  // forms: what was answered in earlier sessions. Who comes again fills in the last forms then.
  BetweenTrials(Parts parts, const std::vector<results::FormAnswerRow>& forms,
                bool comes_again = false);
  // All throw Stopped if the participant stops, and TookNoPart after an answer that ends the
  // session.
  void begin(bool has_trials);
  // What is presented to who answered so; begin is over.
  protocols::Schedule presented(const protocols::Schedule& schedule) const;
  void before(const protocols::PlannedTrial& trial, const protocols::Schedule& presented);
  void after_last_trial(const protocols::Schedule& presented);

 private:
  // nullopt: after all blocks.
  void ask_after_blocks(const protocols::Schedule& presented,
                        const std::optional<std::string>& up_to);
  void read(const std::string& text, const std::optional<protocols::Picture>& picture,
            const std::string& whose);
  void introduce(const protocols::Block& block, const protocols::Schedule& presented);
  bool are_mixed(const std::string& one, const std::string& other) const;
  void rest_if_due(const protocols::Block& block);
  // Of these forms what is asked now and was not asked here before.
  void ask(const std::vector<std::string>& forms, const std::string& asked);
  void ask(const protocols::Form& form, const std::string& asked);
  Parts parts_;
  bool comes_again_;
  std::set<std::pair<std::string, std::string>> asked_;  // forms, and where
  protocols::FilledForms filled_;
  protocols::FilledForms filled_before_;  // the first trial
  bool has_begun_{false};
  std::optional<std::string> block_;
  int trials_since_rest_{0};
  double rested_at_s_{0.0};  // or the block's begin
};
}  // namespace tapstudy::runner
