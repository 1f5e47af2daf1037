#include "analysis/report/confusion/chance_tests.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/statistics/resampling/replicates.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int max_draws = 9999;
constexpr int min_draws = 999;  // p can then fall to .001
constexpr std::size_t most_redrawn = 20'000;

RightAnswers same_level(const ConfusionMatrix& matrix, const std::string& factor) {
  RightAnswers right;
  for (const Item& stimulus : matrix.stimuli) {
    right.emplace_back();
    for (const Item& response : matrix.responses) {
      const auto level = response.factors.find(factor);
      right.back().push_back(level != response.factors.end() &&
                             level->second == stimulus.factors.at(factor));
    }
  }
  return right;
}

// The place of an answer that is right for each stimulus; 0 where none is.
std::vector<int> first_right_responses(const RightAnswers& right) {
  std::vector<int> first;
  for (const std::vector<bool>& of_stimulus : right) {
    const auto found = std::ranges::find(of_stimulus, true);
    first.push_back(found == of_stimulus.end()
                        ? 0
                        : static_cast<int>(std::distance(of_stimulus.begin(), found)));
  }
  return first;
}

// responses: instead of the answers given, by stimulus; empty: those given.
NullTables by_own_orders(const BlockDesign& design, const IdentificationData& data,
                         const std::vector<int>& responses) {
  std::vector<Answers> answers;
  for (const IdentifyingParticipant& person : data.participants) {
    answers.emplace_back();
    for (const IdentifiedTrial& trial : person.trials) {
      answers.back().stimuli.push_back(static_cast<int>(trial.stimulus));
      answers.back().responses.push_back(responses.empty() ? static_cast<int>(trial.response)
                                                           : responses.at(trial.stimulus));
    }
  }
  const Redraw redraw = [participants = data.participants, order_of = design.redraw](
                            std::size_t person, std::uint64_t draw) {
    const std::vector<int> order = order_of(participants[person].place, draw);
    std::vector<int> stimuli;
    for (const IdentifiedTrial& trial : participants[person].trials) {
      stimuli.push_back(order.at(trial.place));
    }
    return stimuli;
  };
  NullTables tables =
      redrawn_tables(std::move(answers), redraw, data.stimuli.size(), data.responses.size());
  tables.work *= design.redraw_cost;
  return tables;
}

NullTables by_shuffles(const IdentificationData& data) {
  std::vector<CountTable> tables;
  for (const IdentifyingParticipant& person : data.participants) {
    tables.push_back(counts_of(data, person));
  }
  return shuffled_tables(tables);
}
}  // namespace

Randomisation randomisation_of(const BlockDesign& design, const IdentificationData& data) {
  std::size_t answers = 0;
  for (const IdentifyingParticipant& person : data.participants) {
    answers += person.trials.size();
  }
  if (answers == 0) {
    return {{}, "there are no answers"};
  }
  if (!design.redraw && design.is_order_known) {
    return {{},
            "the order was listed, not drawn, so that no randomisation says what chance would "
            "give"};
  }
  if (design.redraw && answers <= most_redrawn) {
    const auto all_right = first_right_responses(right_answers({data.stimuli, data.responses}));
    return {by_own_orders(design, data, {}), "draws of the study's own orders",
            by_own_orders(design, data, all_right)};
  }
  return {by_shuffles(data),
          design.is_order_known
              ? "shuffles of each participant's answers, too many to draw the study's orders"
              : "shuffles of each participant's answers, which holds where each of them had the "
                "stimuli in one random order, not in one for each repetition"};
}

Randomisation randomisation_of(const CountTable& counts) {
  if (totals_of(counts).all == 0) {
    return {{}, "there are no answers"};
  }
  return {shuffled_tables({counts}),
          "shuffles of all answers, which holds where answers are independent"};
}

int Draws::of(const NullTables& tables) const {
  return draws > 0 ? draws : affordable_replicates(tables.work, min_draws, max_draws);
}

RightAnswers right_answers(const ConfusionMatrix& matrix) {
  RightAnswers right;
  for (const Item& stimulus : matrix.stimuli) {
    right.emplace_back();
    for (const Item& response : matrix.responses) {
      right.back().push_back(stimulus.is_answered_by(response.name));
    }
  }
  return right;
}

std::optional<double> share_of_constant_answer(const ConfusionMatrix& matrix) {
  const auto right = by_right_response(matrix.stimuli, matrix.responses, matrix.counts);
  if (!right) {
    return std::nullopt;
  }
  const TableTotals totals = totals_of(*right);
  std::vector<std::int64_t> presented = totals.rows;
  std::erase(presented, 0);
  const auto [least, most] = std::ranges::minmax(presented);
  return least == most ? std::nullopt
                       : std::optional{static_cast<double>(most) / static_cast<double>(totals.all)};
}

ChanceTests chance_tests(const Randomisation& randomisation, const ConfusionMatrix& matrix,
                         const std::vector<std::string>& factors, const Draws& wanted) {
  if (!randomisation.tables) {
    return {randomisation.words, {}, {}};
  }
  std::vector<RightAnswers> notions{right_answers(matrix)};
  for (const std::string& factor : factors) {
    notions.push_back(same_level(matrix, factor));
  }
  const auto results = permutation_tests(*randomisation.tables, notions,
                                         wanted.of(*randomisation.tables), wanted.seed);
  ChanceTests tests;
  tests.accuracy = results.front();
  tests.test = fmt::format("randomisation test by {} {}, one-sided", tests.accuracy->draws,
                           randomisation.words);
  tests.factors.assign(results.begin() + 1, results.end());
  return tests;
}

bool is_smallest_p(const Randomisation& randomisation, const ConfusionMatrix& matrix,
                   const PermutationResult& accuracy, const Draws& wanted) {
  return randomisation.if_all_right && accuracy.as_good > 0 &&
         permutation_tests(*randomisation.if_all_right, {right_answers(matrix)}, accuracy.draws,
                           wanted.seed)
                 .front()
                 .as_good == accuracy.as_good;
}

std::optional<double> smallest_chance_p(const BlockDesign& design,
                                        const std::vector<Place>& participants) {
  if (!design.redraw) {
    return std::nullopt;
  }
  constexpr std::uint64_t any_draw = 0;
  IdentificationData data{design.stimuli, design.responses, {}};
  for (const Place& place : participants) {
    IdentifyingParticipant& person = data.participants.emplace_back();
    person.place = place;
    const std::vector<int> order = design.redraw(place, any_draw);
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (order[i] >= 0) {  // no catch trial
        IdentifiedTrial& trial = person.trials.emplace_back();
        trial.stimulus = static_cast<std::size_t>(order[i]);
        trial.place = i;
      }
    }
  }
  const Randomisation randomisation = randomisation_of(design, data);
  if (!randomisation.if_all_right) {
    return std::nullopt;
  }
  constexpr double well_below = 0.01;
  const auto p_of = [&](int draws) {
    return permutation_tests(*randomisation.if_all_right,
                             {right_answers({data.stimuli, data.responses})}, draws, 1)
        .front()
        .p;
  };
  const double roughly = p_of(min_draws);
  return roughly > well_below ? p_of(max_draws) : roughly;
}

std::optional<double> chance_p_of(const IdentifyingParticipant& person, const BlockDesign& design,
                                  const IdentificationData& data) {
  const IdentificationData own{data.stimuli, data.responses, {person}};
  ConfusionMatrix matrix{data.stimuli, data.responses};
  matrix.counts = counts_of(data, person);
  const ChanceTests tests =
      chance_tests(randomisation_of(design, own), matrix, {}, Draws{draws_of_a_participant});
  return tests.accuracy ? std::optional{tests.accuracy->p} : std::nullopt;
}
}  // namespace tapstudy::analysis
