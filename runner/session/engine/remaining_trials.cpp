#include "runner/session/engine/remaining_trials.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "protocols/schedule/schedule.hpp"
#include "runner/session/engine/adaptive_blocks.hpp"
#include "runner/session/engine/between_trials.hpp"
#include "runner/session/engine/practice.hpp"
namespace tapstudy::runner {
std::vector<int> given_up_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store) {
  std::vector<int> given_up;
  for (const results::UnansweredTrial& trial : store.unanswered_trials(participant_id)) {
    const protocols::Block& block = protocol.block(trial.block);
    if (trial.is_skipped ? !do_skipped_trials_come_again(block)
                         : block.explore.at_limit == protocols::AtLimit::give_up) {
      given_up.push_back(trial.number);
    }
  }
  return given_up;
}

std::vector<int> unneeded_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store) {
  const auto session = store.latest_session(participant_id);
  if (!session || std::ranges::none_of(protocol.blocks, [](const protocols::Block& block) {
        return block.presented_if || protocols::may_end_early(block);
      })) {
    return {};
  }
  const protocols::Schedule schedule = protocols::make_schedule(
      protocol, session->seed, session->order_index, session->planned_order);
  const auto as_given = store.answers_as_given(participant_id);
  const PracticeRecord practice{as_given};
  const AdaptiveBlocks adaptive{protocol, session->seed, schedule, as_given};
  const std::vector<int> answered = store.answered_trials(participant_id);
  std::set<int> done{answered.begin(), answered.end()};
  const std::vector<int> given_up = given_up_trials(protocol, participant_id, store);
  done.insert(given_up.begin(), given_up.end());
  const protocols::FilledForms filled = filled_before(store.form_answers_of(participant_id));
  std::vector<int> unneeded;
  for (const protocols::PlannedTrial& trial : schedule) {
    const protocols::Block& block = protocol.block(trial.block);
    const bool is_over =
        !is_presented(block, filled) || practice.is_met(block) || adaptive.is_over(trial);
    if (is_over && !done.contains(trial.number)) {
      unneeded.push_back(trial.number);
    }
  }
  return unneeded;
}

TrialsDone trials_done(const protocols::Protocol& protocol, const std::string& participant_id,
                       results::Store& store) {
  const auto session = store.latest_session(participant_id);
  return {std::ssize(store.answered_trials(participant_id)) +
              std::ssize(given_up_trials(protocol, participant_id, store)) +
              std::ssize(unneeded_trials(protocol, participant_id, store)),
          session ? std::ranges::count(session->planned_order, '\n') : 0};
}

using protocols::PlannedTrial;

void put_at_end_of_block(const PlannedTrial& trial, std::deque<PlannedTrial>& waiting) {
  const auto last = std::find_if(waiting.rbegin(), waiting.rend(), [&](const PlannedTrial& other) {
    return other.block == trial.block;
  });
  waiting.insert(last == waiting.rend() ? waiting.begin() : last.base(), trial);
}

std::deque<PlannedTrial> waiting_trials(const protocols::Schedule& schedule,
                                        const std::set<int>& done,
                                        const std::vector<int>& requeued) {
  std::deque<PlannedTrial> waiting;
  std::ranges::copy_if(schedule, std::back_inserter(waiting),
                       [&](const PlannedTrial& trial) { return !done.contains(trial.number); });
  for (const int number : requeued) {
    const auto found = std::ranges::find(waiting, number, &PlannedTrial::number);
    if (found == waiting.end()) {
      continue;
    }
    auto end = std::next(found);
    for (auto other = end; other != waiting.end(); ++other) {
      end = other->block == found->block ? std::next(other) : end;
    }
    std::rotate(found, std::next(found), end);
  }
  return waiting;
}

SessionProgress::SessionProgress(const protocols::Schedule& schedule, const std::set<int>& done,
                                 const protocols::Protocol& protocol) {
  for (const protocols::Block& block : protocol.blocks) {
    kinds_[block.name] = {block.is_practice, protocols::may_end_early(block)};
    Counts& counts = block.is_practice ? practice_ : counted_;
    counts.is_open_ended |=
        may_procedures_end_early(block) &&
        std::ranges::find(schedule, block.name, &PlannedTrial::block) != schedule.end();
  }
  for (const PlannedTrial& trial : schedule) {
    const Kind& kind = kinds_.at(trial.block);
    ++(kind.is_practice ? practice_ : counted_).total;
    waiting_that_may_end_early_ += kind.may_end_early ? 1 : 0;
    if (done.contains(trial.number)) {
      note_done(trial);
    }
  }
}

void SessionProgress::note_done(const PlannedTrial& trial) {
  const Kind& kind = kinds_.at(trial.block);
  ++(kind.is_practice ? practice_ : counted_).done;
  waiting_that_may_end_early_ -= kind.may_end_early ? 1 : 0;
}

TrialProgress SessionProgress::before(const PlannedTrial& trial) const {
  const bool is_practice = kinds_.at(trial.block).is_practice;
  const Counts& counts = is_practice ? practice_ : counted_;
  return {counts.done, counts.total, is_practice, counts.is_open_ended};
}

std::optional<double> SessionProgress::left_s(double presented_in_s, int presented) const {
  constexpr int fewest = 3;
  if (presented < fewest || waiting_that_may_end_early_ > 0) {
    return std::nullopt;
  }
  const int waiting = practice_.total - practice_.done + counted_.total - counted_.done;
  return presented_in_s / presented * waiting;
}
}  // namespace tapstudy::runner
