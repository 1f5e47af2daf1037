#include "runner/experiments/counted_answers.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "results/stored_answers.hpp"
namespace tapstudy::runner {
std::vector<results::AnswerRow> counted_answers(results::Store& store, results::Mode mode) {
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::vector<results::AnswerRow> answers = results::stored_answers(store);
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.mode != mode || answer.is_practice || answer.is_catch ||
           excluded.contains(answer.participant_id);
  });
  // simulated participants take part at the same time: sums over them must not depend on who is
  // first
  std::ranges::stable_sort(answers, {}, &results::AnswerRow::participant_index);
  results::AlternativesOfTrials alternatives = store.alternatives();
  for (results::AnswerRow& answer : answers) {
    answer.alternatives = std::move(alternatives[answer.trial_id]);
  }
  return answers;
}
}  // namespace tapstudy::runner
