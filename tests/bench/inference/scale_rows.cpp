#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/rank_tests.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
constexpr Eigen::Index items = 4;
constexpr std::array<double, items> values{0.9, 0.2, -0.3, -0.8};
constexpr double spread = 0.7;  // of people's own values
using Values = std::array<double, items>;

Values values_of_person(core::Rng& rng) {
  Values own = values;
  for (double& value : own) {
    value += spread * rng.normal();
  }
  return own;
}

using Judges = std::vector<analysis::PairedCounts>;

// Every pair three times, by people who differ; some stop after the first.
Judges judges_of(const StudyDraw& draw) {
  Judges judges;
  for (int person = 0; person < draw.people; ++person) {
    const Values own = values_of_person(draw.rng);
    analysis::PairedCounts counts{Eigen::MatrixXi::Zero(items, items), {}};
    const int repetitions = draw.rng.below(4) == 0 ? 1 : 3;
    for (int i = 0; i < items; ++i) {
      for (int j = 0; j < i; ++j) {
        const double p = 1.0 / (1.0 + std::exp(own[j] - own[i]));
        const auto wins = static_cast<int>(answered(p, repetitions, draw.rng).successes);
        counts.wins(i, j) = wins;
        counts.wins(j, i) = repetitions - wins;
      }
    }
    judges.push_back(counts);
  }
  return judges;
}

constexpr int many = 20000;  // people, of whom the truth is taken

std::optional<Outcome> bradley_terry_value(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{3};
    return analysis::bradley_terry({sum(judges_of({many, rng}))}).scale.values[0];
  }();
  return holds(analysis::bradley_terry(judges_of(draw)).scale.intervals[0], truth);
}

std::optional<Outcome> thurstone_value(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{4};
    return analysis::thurstone_case_v({sum(judges_of({many, rng}))}).values[0];
  }();
  return holds(analysis::thurstone_case_v(judges_of(draw)).intervals[0], truth);
}

double share_preferred(const Judges& judges, std::vector<analysis::Proportion>& people) {
  double mean = 0.0;
  for (const auto& counts : judges) {
    people.push_back(
        {counts.wins.row(0).sum(), counts.wins.row(0).sum() + counts.wins.col(0).sum()});
    mean += people.back().value() / static_cast<double>(judges.size());
  }
  return mean;
}

std::optional<Outcome> mean_preferred(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{5};
    std::vector<analysis::Proportion> people;
    return share_preferred(judges_of({many, rng}), people);
  }();
  std::vector<analysis::Proportion> people;
  share_preferred(judges_of(draw), people);
  return holds(*analysis::mean_share(people)->interval, truth);
}

// Guessers name places; the stimuli in them are drawn. 3 pairs hold the stimulus, three times each.
std::optional<Outcome> declared_preferred(const StudyDraw& draw) {
  std::vector<double> differences;
  for (int person = 0; person < draw.people; ++person) {
    std::optional<std::size_t> last;
    double difference = 0.0;
    for (int trial = 0; trial < 9; ++trial) {
      last = guess(draw.guesser, 2, last, draw.rng);
      difference += *last == draw.rng.below(2) ? 1.0 : -1.0;
    }
    differences.push_back(difference);
  }
  return sign_test_of(differences);
}

// Places by exponential times of people who differ: Plackett and Luce's model for each.
std::vector<std::vector<analysis::Ranking>> rankings_of(const StudyDraw& draw) {
  std::vector<std::vector<analysis::Ranking>> all;
  for (int person = 0; person < draw.people; ++person) {
    const Values own = values_of_person(draw.rng);
    std::vector<analysis::Ranking>& rankings = all.emplace_back();
    for (int i = 0; i < 3; ++i) {
      std::array<std::pair<double, std::size_t>, items> times;
      for (std::size_t item = 0; item < items; ++item) {
        times[item] = {-std::log1p(-draw.rng.uniform()) * std::exp(-own[item]), item};
      }
      std::ranges::sort(times);
      rankings.emplace_back();
      for (const auto& [time, item] : times) {
        rankings.back().push_back(item);
      }
    }
  }
  return all;
}

std::optional<Outcome> worth(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{6};
    return analysis::plackett_luce(rankings_of({many, rng}), items).values[0];
  }();
  return holds(analysis::plackett_luce(rankings_of(draw), items).intervals[0], truth);
}

std::optional<Outcome> worth_difference(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{8};
    const auto scale = analysis::plackett_luce(rankings_of({many, rng}), items);
    return scale.values[0] - scale.values[1];
  }();
  const auto scale = analysis::plackett_luce(rankings_of(draw), items);
  return holds(analysis::difference(scale, 0, 1).interval, truth);
}
}  // namespace

std::vector<Row> rows_of_scales() {
  using enum Kind;
  return {
      {size, "paired", "a declared stimulus, sign test", By::guessers, declared_preferred},
      {coverage, "paired", "share preferred", By::people, mean_preferred},
      {coverage, "paired", "value by Bradley and Terry", By::people, bradley_terry_value},
      {coverage, "paired", "value by Thurstone", By::people, thurstone_value},
      {coverage, "ranking", "worth by Plackett and Luce", By::people, worth},
      {coverage, "ranking", "difference of two worths", By::people, worth_difference},
  };
}
}  // namespace tapstudy::bench
