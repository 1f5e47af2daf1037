#include "runner/session/engine/between_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
protocols::FilledForms filled_forms(const std::vector<results::FormAnswerRow>& answers) {
  protocols::FilledForms filled;
  std::map<std::string, std::string> asked;  // where, by form
  for (const results::FormAnswerRow& row : answers) {
    protocols::FormAnswers& form = filled[row.form];
    if (std::exchange(asked[row.form], row.asked) != row.asked) {
      form.clear();
    }
    if (row.answer) {
      form[row.item] = *row.answer;
    }
  }
  return filled;
}

protocols::FilledForms filled_before(const std::vector<results::FormAnswerRow>& answers) {
  std::vector<results::FormAnswerRow> before;
  std::ranges::copy_if(answers, std::back_inserter(before), [](const results::FormAnswerRow& row) {
    return row.asked == asked_at_begin;
  });
  return filled_forms(before);
}

std::optional<std::string> ending_answer(const protocols::Protocol& protocol,
                                         const std::vector<results::FormAnswerRow>& answers) {
  for (const auto& [name, given] : filled_forms(answers)) {
    const auto form = protocol.forms.find(name);
    if (form == protocol.forms.end()) {
      continue;
    }
    if (const auto ending = item_that_ends(form->second, given)) {
      return protocols::describe({name, ending->name, {given.at(ending->name)}});
    }
  }
  return std::nullopt;
}

BetweenTrials::BetweenTrials(Parts parts, const std::vector<results::FormAnswerRow>& forms,
                             bool comes_again)
    : parts_{std::move(parts)},
      comes_again_{comes_again},
      filled_{filled_forms(forms)},
      filled_before_{filled_before(forms)} {
  for (const results::FormAnswerRow& row : forms) {
    asked_.emplace(row.form, row.asked);
  }
}

protocols::Schedule BetweenTrials::presented(const protocols::Schedule& schedule) const {
  protocols::Schedule presented;
  std::ranges::copy_if(schedule, std::back_inserter(presented),
                       [&](const protocols::PlannedTrial& trial) {
                         return is_presented(parts_.protocol.block(trial.block), filled_before_);
                       });
  return presented;
}

bool is_end_of_practice_said(const protocols::Block& before, const protocols::Block& block) {
  return before.is_practice && !block.is_practice && block.instructions.empty();
}

void BetweenTrials::begin(bool has_trials) {
  if (!has_begun_) {
    has_begun_ = true;
    read(has_trials ? parts_.protocol.instructions : "", parts_.protocol.instructions_picture,
         "study");
    ask(parts_.protocol.forms_before, asked_at_begin);
  }
}

bool BetweenTrials::are_mixed(const std::string& one, const std::string& other) const {
  return parts_.protocol.are_mixed(parts_.protocol.block(one), parts_.protocol.block(other));
}

// Also those of a block that an earlier session finished, but for its questionnaires.
void BetweenTrials::ask_after_blocks(const protocols::Schedule& presented,
                                     const std::optional<std::string>& up_to) {
  for (const protocols::PlannedTrial& trial : presented) {
    if (up_to && are_mixed(trial.block, *up_to)) {
      return;
    }
    ask(parts_.protocol.block(trial.block).forms_after, trial.block);
  }
}

void BetweenTrials::before(const protocols::PlannedTrial& trial,
                           const protocols::Schedule& presented) {
  const protocols::Block& block = parts_.protocol.block(trial.block);
  if (!block_ || !are_mixed(*block_, trial.block)) {
    ask_after_blocks(presented, trial.block);
    introduce(block, presented);
    trials_since_rest_ = 0;
    rested_at_s_ = parts_.states.now_s();
  }
  block_ = trial.block;
  rest_if_due(parts_.protocol.leader(block));
  ++trials_since_rest_;
}

// With the blocks that are mixed with it, in the protocol's order.
void BetweenTrials::introduce(const protocols::Block& block, const protocols::Schedule& presented) {
  for (const protocols::Block& other : parts_.protocol.blocks) {
    if (are_mixed(other.name, block.name) &&
        std::ranges::find(presented, other.name, &protocols::PlannedTrial::block) !=
            presented.end()) {
      read(other.instructions, other.instructions_picture, other.name);
    }
  }
  if (block_ && is_end_of_practice_said(parts_.protocol.block(*block_), block)) {
    parts_.wait_while_paused();
    parts_.states.enter(SessionState::instructions, {}, block.name);
    parts_.participant.practice_is_over();
  }
}

void BetweenTrials::rest_if_due(const protocols::Block& block) {
  if (block.breaks &&
      block.breaks->are_due(trials_since_rest_, parts_.states.now_s() - rested_at_s_)) {
    parts_.wait_while_paused();
    parts_.states.enter(SessionState::resting);
    parts_.participant.rest(*block.breaks);
    trials_since_rest_ = 0;
    rested_at_s_ = parts_.states.now_s();
  }
}

// A session that was interrupted just before its last questionnaires has no trial left.
void BetweenTrials::after_last_trial(const protocols::Schedule& presented) {
  ask_after_blocks(presented, std::nullopt);
  if (!comes_again_) {
    ask(parts_.protocol.forms_after, asked_at_end);
  }
}

void BetweenTrials::read(const std::string& text, const std::optional<protocols::Picture>& picture,
                         const std::string& whose) {
  if (!text.empty()) {
    parts_.wait_while_paused();
    parts_.states.enter(SessionState::instructions, {}, whose);
    parts_.participant.read(text, picture);
  }
}

void BetweenTrials::ask(const std::vector<std::string>& forms, const std::string& asked) {
  for (const std::string& name : forms) {
    const protocols::Form form = form_after(parts_.protocol.forms.at(name), filled_);
    if (parts_.participant.fills_in_forms() && !asked_.contains({name, asked}) &&
        !form.items.empty()) {
      ask(form, asked);
    }
  }
}

void BetweenTrials::ask(const protocols::Form& form, const std::string& asked) {
  parts_.wait_while_paused();
  parts_.states.enter(SessionState::form, {}, form.name);
  const protocols::FormAnswers answers = parts_.participant.fill_in(form);
  const auto ending = item_that_ends(form, answers);
  std::vector<results::FormAnswerRow> rows;
  for (const protocols::FormItem& item :
       ending ? std::vector{*ending} : asked_items(form, answers)) {
    const auto answer = answers.find(item.name);
    rows.push_back({0, 0.0, form.name, asked, item.name,
                    answer == answers.end() ? std::nullopt : std::optional{answer->second}});
  }
  parts_.save_form(std::move(rows));
  if (ending) {
    throw TookNoPart{protocols::describe({form.name, ending->name, {answers.at(ending->name)}})};
  }
  asked_.emplace(form.name, asked);
  filled_[form.name] = answers;
  if (asked == asked_at_begin) {
    filled_before_[form.name] = answers;
  }
}
}  // namespace tapstudy::runner
