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

TrialProgress progress_at(const protocols::PlannedTrial& trial, const protocols::Schedule& schedule,
                          const std::set<int>& done, const protocols::Protocol& protocol) {
  const auto is_practice = [&](const protocols::PlannedTrial& of) {
    return protocol.block(of.block).is_practice;
  };
  TrialProgress progress{0, 0, is_practice(trial)};
  for (const protocols::PlannedTrial& other : schedule) {
    const bool is_of_it = is_practice(other) == progress.is_practice;
    progress.total += is_of_it ? 1 : 0;
    progress.done += is_of_it && done.contains(other.number) ? 1 : 0;
    progress.is_open_ended |= is_of_it && may_procedures_end_early(protocol.block(other.block));
  }
  return progress;
}

std::optional<double> time_left_s(const protocols::Schedule& schedule, const std::set<int>& done,
                                  const protocols::Protocol& protocol, double presented_in_s,
                                  int presented) {
  constexpr int fewest = 3;
  const auto is_waiting = [&](const protocols::PlannedTrial& trial) {
    return !done.contains(trial.number);
  };
  const bool may_end_early = std::ranges::any_of(schedule, [&](const auto& trial) {
    return is_waiting(trial) && protocols::may_end_early(protocol.block(trial.block));
  });
  if (presented < fewest || may_end_early) {
    return std::nullopt;
  }
  return presented_in_s / presented *
         static_cast<double>(std::ranges::count_if(schedule, is_waiting));
}
}  // namespace tapstudy::runner
