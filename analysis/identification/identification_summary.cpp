#include "analysis/identification/identification_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "analysis/statistics/permutation_test.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr int max_draws = 9999;
constexpr int min_draws = 999;  // p can then fall to .001
constexpr std::uint64_t draws_seed = 1;

// As many as can be computed quickly; the report states the number.
int draws_for(std::size_t answers) {
  constexpr std::size_t max_work = 20'000'000;
  return static_cast<int>(
      std::clamp<std::size_t>(max_work / std::max<std::size_t>(answers, 1), min_draws, max_draws));
}

std::vector<FactorResult> factor_results(const ConfusionMatrix& matrix) {
  std::vector<FactorResult> found;
  if (std::ranges::any_of(matrix.stimuli, [](const Item& stimulus) {
        return !stimulus.is_answered_by(stimulus.name);
      })) {
    return found;  // a factor's levels were asked for: there is no more in an answer
  }
  const std::vector<std::string> factors = factors_of(matrix);
  for (const std::string& factor : factors) {
    found.push_back(
        {factor, "", factor_accuracy(matrix, factor), factor_chance(matrix, factor, "")});
  }
  for (const std::string& factor : factors) {
    for (const std::string& given : factors) {
      if (factor != given) {
        found.push_back({factor, given, conditional_accuracy(matrix, factor, given),
                         factor_chance(matrix, factor, given)});
      }
    }
  }
  return found;
}
void check_correctness(const BlockDesign& design, const AnswerRow& answer) {
  if (!answer.is_correct) {
    throw core::InvalidInput{
        fmt::format("block '{}': the answer of {} to trial {} is neither right nor wrong",
                    design.name, answer.participant_id, answer.number)};
  }
  const auto presented = std::ranges::find(design.stimuli, answer.stimulus, &Item::name);
  if (presented != design.stimuli.end() &&
      *answer.is_correct != presented->is_answered_by(answer.response)) {
    throw core::InvalidInput{fmt::format(
        "block '{}': the answer of {} to trial {} is stored as {}, which a confusion matrix of "
        "'{}' answered '{}' contradicts",
        design.name, answer.participant_id, answer.number,
        *answer.is_correct ? "correct" : "incorrect", answer.stimulus, answer.response)};
  }
}

// A participant's answers of a block, with the places of their trials in its order.
struct Person {
  Place place;
  Answers answers;
  std::vector<std::size_t> places;
};

// Which of the answers is right for a stimulus; one that cannot be answered has a code of its own.
int right_answer(const BlockDesign& design, std::size_t stimulus) {
  const auto right = std::ranges::find_if(design.responses, [&](const Item& response) {
    return design.stimuli[stimulus].is_answered_by(response.name);
  });
  const auto codes = design.responses.size();
  return static_cast<int>(right != design.responses.end()
                              ? static_cast<std::size_t>(right - design.responses.begin())
                              : codes + stimulus);
}

int code_of(const std::vector<Item>& items, const std::string& name) {
  return static_cast<int>(std::ranges::find(items, name, &Item::name) - items.begin());
}

std::vector<Person> people_of(const BlockDesign& design, const std::vector<AnswerRow>& answers) {
  std::vector<Person> people;
  std::map<std::string, std::size_t> place_of_person;
  for (const AnswerRow& answer : answers) {
    const auto [person, is_new] = place_of_person.emplace(answer.participant_id, people.size());
    if (is_new) {
      people.push_back({{answer.participant_index, answer.order_index}, {}, {}});
    }
    Person& of = people[person->second];
    of.answers.stimuli.push_back(
        right_answer(design, static_cast<std::size_t>(code_of(design.stimuli, answer.stimulus))));
    of.answers.responses.push_back(code_of(design.responses, answer.response));
    of.places.push_back(static_cast<std::size_t>(answer.number - design.first_trial));
  }
  return people;
}

PermutationResult accuracy_test(const BlockDesign& design, const std::vector<AnswerRow>& rows) {
  const std::vector<Person> people = people_of(design, rows);
  std::vector<Answers> answers;
  std::ranges::transform(people, std::back_inserter(answers), &Person::answers);
  const Redraw redraw = [&](std::size_t person, std::uint64_t draw) {
    const std::vector<int> order = design.redraw(people[person].place, draw);
    std::vector<int> stimuli;
    for (const std::size_t place : people[person].places) {
      stimuli.push_back(right_answer(design, static_cast<std::size_t>(order.at(place))));
    }
    return stimuli;
  };
  return permutation_test(answers, redraw, draws_for(rows.size()), draws_seed);
}

HypothesisResult tested(const BlockDesign& design, const BlockRows& rows,
                        const PlannedHypothesis& planned, const IdentificationSummary& summary) {
  HypothesisResult result{planned, "", summary.accuracy, summary.matrix.chance(), {}, 0.0};
  if (rows.answers.empty()) {
    result.test = "there are no answers";
  } else if (!design.redraw) {
    result.test =
        "the order was listed, not drawn, so that no randomisation says what chance would give";
  } else {
    const PermutationResult test = accuracy_test(design, rows.answers);
    result.p = test.p;
    result.p_floor = test.as_good == 0 ? test.p : 0.0;
    result.test = fmt::format("randomisation test by {} draws of the study's own orders, one-sided",
                              test.draws);
  }
  return result;
}
}  // namespace

IdentificationSummary::IdentificationSummary(const BlockDesign& design, ConfusionMatrix counted)
    : BlockSummary{design},
      matrix{std::move(counted)},
      accuracy{overall_accuracy(matrix)},
      factors{factor_results(matrix)} {}

std::shared_ptr<const BlockSummary> summarise_identification(const BlockDesign& design,
                                                             const BlockRows& rows) {
  ConfusionMatrix matrix{design.stimuli, design.responses};
  std::vector<ParticipantAccuracy> participants;
  for (const AnswerRow& answer : rows.answers) {
    check_correctness(design, answer);
    matrix.add(answer.stimulus, answer.response);
    auto person = std::ranges::find(participants, answer.participant_id,
                                    &ParticipantAccuracy::participant_id);
    if (person == participants.end()) {
      person = participants.insert(person, {answer.participant_id, {}});
    }
    ++person->accuracy.trials;
    person->accuracy.successes += *answer.is_correct ? 1 : 0;
  }
  auto summary = std::make_shared<IdentificationSummary>(design, std::move(matrix));
  summary->participants = std::move(participants);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(tested(design, rows, planned, *summary));
  }
  return summary;
}
}  // namespace tapstudy::analysis
