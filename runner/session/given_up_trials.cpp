#include "runner/session/given_up_trials.hpp"

#include <algorithm>

#include "protocols/schedule.hpp"
#include "runner/session/practice_record.hpp"
namespace tapstudy::runner {
std::vector<int> given_up_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store) {
  std::vector<int> given_up;
  for (const results::UnansweredTrial& trial : store.unanswered_trials(participant_id)) {
    if (trial.is_skipped ||
        protocol.block(trial.block).explore.at_limit == protocols::AtLimit::give_up) {
      given_up.push_back(trial.number);
    }
  }
  return given_up;
}

std::vector<results::AnswerRow> answers_of(const std::string& participant_id,
                                           results::Store& store) {
  std::vector<results::AnswerRow> answers = store.answers();
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.participant_id != participant_id;
  });
  return answers;
}

std::vector<int> unneeded_trials(const protocols::Protocol& protocol,
                                 const std::string& participant_id, results::Store& store) {
  const std::vector<results::AnswerRow> answers = answers_of(participant_id, store);
  const PracticeRecord practice{answers};
  const std::vector<int> given_up = given_up_trials(protocol, participant_id, store);
  std::vector<int> unneeded;
  int number = 0;
  for (const protocols::Block& block : protocol.blocks) {
    const bool is_met = practice.is_met(block);
    for (int i = 0; i < planned_trials(block); ++i) {
      ++number;
      const bool is_answered =
          std::ranges::find(answers, number, &results::AnswerRow::number) != answers.end();
      if (is_met && !is_answered && std::ranges::find(given_up, number) == given_up.end()) {
        unneeded.push_back(number);
      }
    }
  }
  return unneeded;
}
}  // namespace tapstudy::runner
