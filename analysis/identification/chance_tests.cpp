#include "analysis/identification/chance_tests.hpp"

#include <fmt/format.h>

#include "analysis/resampling/random_table.hpp"
#include "analysis/resampling/replicates.hpp"
namespace tapstudy::analysis {
namespace {
constexpr int max_draws = 9999;
constexpr int min_draws = 999;  // p can then fall to .001
constexpr std::size_t most_redrawn = 20'000;

RightAnswers right_answers(const IdentificationData& data) {
  RightAnswers right;
  for (const Item& stimulus : data.stimuli) {
    right.emplace_back();
    for (const Item& response : data.responses) {
      right.back().push_back(stimulus.is_answered_by(response.name));
    }
  }
  return right;
}

RightAnswers same_level(const IdentificationData& data, const std::string& factor) {
  RightAnswers right;
  for (const Item& stimulus : data.stimuli) {
    right.emplace_back();
    for (const Item& response : data.responses) {
      const auto level = response.factors.find(factor);
      right.back().push_back(level != response.factors.end() &&
                             level->second == stimulus.factors.at(factor));
    }
  }
  return right;
}

std::vector<PermutationResult> by_own_orders(const BlockDesign& design,
                                             const IdentificationData& data,
                                             const std::vector<RightAnswers>& notions,
                                             const ChanceDraws& wanted) {
  std::vector<Answers> answers;
  for (const IdentifyingParticipant& person : data.participants) {
    answers.emplace_back();
    for (const IdentifiedTrial& trial : person.trials) {
      answers.back().stimuli.push_back(static_cast<int>(trial.stimulus));
      answers.back().responses.push_back(static_cast<int>(trial.response));
    }
  }
  const Redraw redraw = [&](std::size_t person, std::uint64_t draw) {
    const std::vector<int> order = design.redraw(data.participants[person].place, draw);
    std::vector<int> stimuli;
    for (const IdentifiedTrial& trial : data.participants[person].trials) {
      stimuli.push_back(order.at(trial.place));
    }
    return stimuli;
  };
  return permutation_tests(answers, redraw, notions, wanted.draws, wanted.seed);
}

std::vector<CountTable> tables_of(const IdentificationData& data) {
  std::vector<CountTable> tables;
  for (const IdentifyingParticipant& person : data.participants) {
    tables.push_back(counts_of(data, person));
  }
  return tables;
}

std::string_view words_of_draws(const BlockDesign& design, bool is_redrawn) {
  if (is_redrawn) {
    return "draws of the study's own orders";
  }
  return design.is_order_known
             ? "shuffles of each participant's answers, too many to draw the study's orders"
             : "shuffles of each participant's answers, which holds where each of them had the "
               "stimuli in random order";
}
}  // namespace

ChanceTests chance_tests(const BlockDesign& design, const IdentificationData& data,
                         const std::vector<std::string>& factors, const ChanceDraws& wanted) {
  std::size_t answers = 0;
  for (const IdentifyingParticipant& person : data.participants) {
    answers += person.trials.size();
  }
  if (answers == 0) {
    return {"there are no answers", {}, {}};
  }
  if (!design.redraw && design.is_order_known) {
    return {"the order was listed, not drawn, so that no randomisation says what chance would give",
            {},
            {}};
  }
  std::vector<RightAnswers> notions{right_answers(data)};
  for (const std::string& factor : factors) {
    notions.push_back(same_level(data, factor));
  }
  const bool is_redrawn = design.redraw && answers <= most_redrawn;
  const std::vector<CountTable> tables = tables_of(data);
  ChanceDraws draws = wanted;
  if (draws.draws == 0) {
    draws.draws = affordable_replicates(is_redrawn ? answers : work_of_random_tables(tables),
                                        min_draws, max_draws);
  }
  const auto results = is_redrawn ? by_own_orders(design, data, notions, draws)
                                  : shuffle_tests(tables, notions, draws.draws, draws.seed);
  ChanceTests tests;
  tests.accuracy = results.front();
  tests.test = fmt::format("randomisation test by {} {}, one-sided", tests.accuracy->draws,
                           words_of_draws(design, is_redrawn));
  tests.factors.assign(results.begin() + 1, results.end());
  return tests;
}
}  // namespace tapstudy::analysis
