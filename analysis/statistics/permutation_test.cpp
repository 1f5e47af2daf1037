#include "analysis/statistics/permutation_test.hpp"

#include <algorithm>
#include <iterator>

#include "analysis/resampling/random_table.hpp"
#include "analysis/resampling/replicates.hpp"
#include "core/rng.hpp"
namespace tapstudy::analysis {
namespace {
// Adds to `right` how many are, by each notion.
using CountRight = std::function<void(std::size_t participant, const std::vector<int>& stimuli,
                                      std::vector<double>& right)>;

std::vector<PermutationResult> compared(const std::vector<double>& observed,
                                        const std::vector<std::vector<double>>& drawn) {
  std::vector<PermutationResult> results;
  for (std::size_t notion = 0; notion < observed.size(); ++notion) {
    const auto as_good = std::ranges::count_if(
        drawn, [&](const std::vector<double>& right) { return right[notion] >= observed[notion]; });
    results.push_back(
        {(1.0 + static_cast<double>(as_good)) / (static_cast<double>(drawn.size()) + 1.0),
         static_cast<int>(as_good), static_cast<int>(drawn.size())});
  }
  return results;
}

std::vector<PermutationResult> tested(const std::vector<Answers>& participants,
                                      const Redraw& redraw, const CountRight& count,
                                      std::size_t notions, int draws, std::uint64_t seed) {
  std::vector<double> observed(notions, 0.0);
  for (std::size_t i = 0; i < participants.size(); ++i) {
    count(i, participants[i].stimuli, observed);
  }
  const auto drawn = replicated_vectors(
      draws,
      [&](std::uint64_t draw) {
        std::vector<double> right(notions, 0.0);
        for (std::size_t i = 0; i < participants.size(); ++i) {
          count(i, redraw(i, draw), right);
        }
        return right;
      },
      seed);
  return compared(observed, drawn);
}

std::vector<double> right_in(const CountTable& counts, const std::vector<RightAnswers>& notions) {
  std::vector<double> right(notions.size(), 0.0);
  for (std::size_t notion = 0; notion < notions.size(); ++notion) {
    for (std::size_t i = 0; i < counts.size(); ++i) {
      for (std::size_t j = 0; j < counts[i].size(); ++j) {
        right[notion] += notions[notion][i][j] ? static_cast<double>(counts[i][j]) : 0.0;
      }
    }
  }
  return right;
}
}  // namespace

PermutationResult permutation_test(const std::vector<Answers>& participants, const Redraw& redraw,
                                   int draws, std::uint64_t seed) {
  const CountRight count = [&](std::size_t person, const std::vector<int>& stimuli,
                               std::vector<double>& right) {
    const std::vector<int>& responses = participants[person].responses;
    for (std::size_t i = 0; i < responses.size(); ++i) {
      right[0] += stimuli.at(i) == responses[i] ? 1.0 : 0.0;
    }
  };
  return tested(participants, redraw, count, 1, draws, seed).front();
}

std::vector<PermutationResult> permutation_tests(const std::vector<Answers>& participants,
                                                 const Redraw& redraw,
                                                 const std::vector<RightAnswers>& notions,
                                                 int draws, std::uint64_t seed) {
  const CountRight count = [&](std::size_t person, const std::vector<int>& stimuli,
                               std::vector<double>& right) {
    const std::vector<int>& responses = participants[person].responses;
    for (std::size_t i = 0; i < responses.size(); ++i) {
      const auto stimulus = static_cast<std::size_t>(stimuli.at(i));
      const auto response = static_cast<std::size_t>(responses[i]);
      for (std::size_t notion = 0; notion < notions.size(); ++notion) {
        right[notion] += notions[notion].at(stimulus).at(response) ? 1.0 : 0.0;
      }
    }
  };
  return tested(participants, redraw, count, notions.size(), draws, seed);
}

std::vector<PermutationResult> shuffle_tests(const std::vector<CountTable>& participants,
                                             const std::vector<RightAnswers>& notions, int draws,
                                             std::uint64_t seed) {
  std::vector<TableTotals> totals;
  std::ranges::transform(participants, std::back_inserter(totals), totals_of);
  const auto drawn = replicated_vectors(
      draws,
      [&](std::uint64_t own_seed) {
        core::Rng rng{own_seed};
        return right_in(sum_of_random_tables(totals, rng), notions);
      },
      seed);
  return compared(right_in(sum_of(participants), notions), drawn);
}
}  // namespace tapstudy::analysis
