#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "analysis/report/blocks/choices.hpp"
#include "analysis/statistics/friedman_test.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/proportion.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
// Votes of people for three alternatives, of which the first has this share.
std::vector<int> votes_of(double share, const StudyDraw& draw) {
  std::vector<int> votes(3, 0);
  for (int person = 0; person < draw.people; ++person) {
    ++votes[draw.rng.uniform() < share ? 0 : 1 + draw.rng.below(2)];
  }
  return votes;
}

std::optional<Outcome> declared_choice(const StudyDraw& draw) {
  const int chosen = votes_of(1.0 / 3.0, draw)[0];
  return Outcome{analysis::binomial_p_at_least({chosen, draw.people}, 1.0 / 3.0)};
}

std::optional<Outcome> all_alike(const StudyDraw& draw) {
  return Outcome{analysis::exact_multinomial_p(votes_of(1.0 / 3.0, draw)).value()};
}

// What was visited first is chosen as often as any of three, in four trials each.
std::optional<Outcome> first_visited(const StudyDraw& draw) {
  const auto chosen = answered(1.0 / 3.0, 4 * draw.people, draw.rng);
  return Outcome{analysis::binomial_two_sided_p(chosen, 1.0 / 3.0)};
}

std::optional<Outcome> share_chosen(const StudyDraw& draw) {
  return holds(analysis::wilson_interval({votes_of(0.5, draw)[0], draw.people}), 0.5);
}

std::optional<Outcome> shares_at_once(const StudyDraw& draw) {
  const auto intervals = analysis::simultaneous_intervals(votes_of(0.5, draw));
  const double truths[]{0.5, 0.25, 0.25};
  double held = 1.0;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    held = std::min(held, holds(intervals[i], truths[i]).value);
  }
  return Outcome{held};
}

// Ratings from 1 to 7 of four stimuli, medians of three, by people who each have a preferred step.
analysis::RatingTable ratings_of(const StudyDraw& draw, double of_first) {
  analysis::RatingTable ratings;
  for (int person = 0; person < draw.people; ++person) {
    const double own = 4.0 + draw.rng.normal();
    ratings.emplace_back();
    for (int stimulus = 0; stimulus < 4; ++stimulus) {
      std::vector<double> three;
      for (int i = 0; i < 3; ++i) {
        const double felt = own + (stimulus == 0 ? of_first : 0.0) + draw.rng.normal();
        three.push_back(std::clamp(std::round(felt), 1.0, 7.0));
      }
      std::ranges::sort(three);
      ratings.back().push_back(three[1]);
    }
  }
  return ratings;
}

analysis::RatingTable places_of(const StudyDraw& draw) {
  analysis::RatingTable places;
  for (int person = 0; person < draw.people; ++person) {
    places.emplace_back();
    for (const std::size_t place : shuffled(4, 1, draw.rng)) {
      places.back().push_back(static_cast<double>(place + 1));
    }
  }
  return places;
}

double squares_of_sums(const analysis::RatingTable& ranks) {
  std::vector<double> sums(ranks.front().size(), 0.0);
  for (const auto& of_person : ranks) {
    std::ranges::transform(sums, of_person, sums.begin(), std::plus<>{});
  }
  return std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0);
}

// With the probability of what is further by 999 shuffles of each participant's ranks.
std::optional<Outcome> friedman(const analysis::RatingTable& table, core::Rng& rng) {
  const double p = analysis::friedman_test(table, 1).p;
  analysis::RatingTable ranks;
  for (const auto& of_person : table) {
    ranks.push_back(analysis::mid_ranks(of_person));
  }
  const double limit = squares_of_sums(ranks) + 1e-6;
  constexpr int shuffles = 999;
  int further = 0;
  for (int i = 0; i < shuffles; ++i) {
    for (auto& of_person : ranks) {
      rng.shuffle(of_person);
    }
    further += squares_of_sums(ranks) > limit ? 1 : 0;
  }
  return Outcome{p, std::min(p, static_cast<double>(further) / shuffles)};
}

std::optional<Outcome> any_pair(const analysis::RatingTable& table) {
  double least = 1.0;
  for (const auto& pair : analysis::pairwise_signed_rank(table)) {
    least = std::min(least, pair.adjusted_p.value_or(1.0));
  }
  return Outcome{least};
}

// The first is as high as the second, and above the others.
std::optional<Outcome> declared_highest(const StudyDraw& draw) {
  auto ratings = ratings_of(draw, 0.0);
  std::vector<double> differences;
  for (const auto& of_person : ratings) {
    differences.push_back(of_person[0] - of_person[1]);
  }
  return sign_test_of(differences);
}

// The first is felt two steps higher, near the end of the scale.
std::optional<Outcome> mean_rating(const StudyDraw& draw) {
  static const double truth = [] {
    core::Rng rng{7};
    double sum = 0.0;
    constexpr int many = 200000;
    for (const auto& of_person : ratings_of({many, rng}, 2.0)) {
      sum += of_person[0] / many;
    }
    return sum;
  }();
  std::vector<double> of_first;
  for (const auto& of_person : ratings_of(draw, 2.0)) {
    of_first.push_back(of_person[0]);
  }
  const auto interval = analysis::bounded_interval(of_first, {1.0, 7.0});
  return interval ? std::optional{holds(*interval, truth)} : std::nullopt;
}

// Scores from 0 to 100 of which most are small.
std::optional<Outcome> mean_score(const StudyDraw& draw) {
  std::vector<double> scores;
  for (int person = 0; person < draw.people; ++person) {
    scores.push_back(100.0 * personal_share(0.2, 0.1, draw.rng));
  }
  return holds(analysis::bounded_interval(scores, {0.0, 100.0}).value(), 20.0);
}
}  // namespace

std::vector<Row> rows_of_choices() {
  using enum Kind;
  return {
      {size, "choice", "a declared alternative", By::people, declared_choice},
      {size, "choice", "all alike", By::people, all_alike},
      {size, "choice", "what was visited first, 4 N trials", By::people, first_visited},
      {coverage, "choice", "a share of 1/2 (Wilson)", By::people, share_chosen},
      {coverage, "choice", "three shares at once (Goodman)", By::people, shares_at_once},
      {size, "ranking", "Friedman", By::people,
       [](const StudyDraw& draw) { return friedman(places_of(draw), draw.rng); }},
      {size, "ranking", "any pair, after Holm", By::people,
       [](const StudyDraw& draw) { return any_pair(places_of(draw)); }},
      {size, "rating", "Friedman", By::people,
       [](const StudyDraw& draw) { return friedman(ratings_of(draw, 0.0), draw.rng); }},
      {size, "rating", "any pair, after Holm", By::people,
       [](const StudyDraw& draw) { return any_pair(ratings_of(draw, 0.0)); }},
      {size, "rating", "declared the highest, equal to one", By::people, declared_highest},
      {coverage, "rating", "mean near the end of 7 steps", By::people, mean_rating},
      {coverage, "questionnaires", "mean of 20 on 0 to 100", By::people, mean_score},
  };
}
}  // namespace tapstudy::bench
