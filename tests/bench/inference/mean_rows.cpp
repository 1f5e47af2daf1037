#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/statistics/detection/rates.hpp"
#include "analysis/statistics/population/independent_groups.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/population/planned_contrasts.hpp"
#include "analysis/statistics/population/test_retest.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/scaling/power_law.hpp"
#include "core/error.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
namespace {
std::vector<double> normal_values(int number, double mean, double spread, core::Rng& rng) {
  std::vector<double> values(static_cast<std::size_t>(number));
  std::ranges::generate(values, [&] { return mean + spread * rng.normal(); });
  return values;
}

// As of thresholds and times, of which few are large.
std::vector<double> skewed_values(int number, core::Rng& rng) {
  std::vector<double> values(static_cast<std::size_t>(number));
  std::ranges::generate(values, [&] { return std::exp(0.5 * rng.normal()); });
  return values;
}

Row coverage_of_share(double mean, Trials trials, const char* words) {
  return {Kind::coverage, "tasks with right answers", fmt::format("mean share {}, {}", mean, words),
          By::correlations, [mean, trials](const StudyDraw& draw) {
            const auto of = analysis::mean_share(sample_of(mean, trials, draw));
            return of->interval ? std::optional{holds(*of->interval, mean)} : std::nullopt;
          }};
}

// Where participants' shares are equal t gives no interval.
Row width_of_share(double mean, Trials trials, const char* words) {
  return {Kind::width, "tasks with right answers", fmt::format("mean share {}, {}", mean, words),
          By::correlations, [mean, trials](const StudyDraw& draw) -> std::optional<Outcome> {
            const auto people = sample_of(mean, trials, draw);
            std::vector<double> shares;
            std::ranges::transform(people, std::back_inserter(shares),
                                   &analysis::Proportion::value);
            const auto of = analysis::mean_share(people);
            const analysis::Interval t = analysis::t_interval(shares);
            if (!of->interval || t.low == t.high) {
              return std::nullopt;
            }
            return Outcome{of->interval->high - of->interval->low,
                           std::min(t.high, 1.0) - std::max(t.low, 0.0)};
          }};
}

std::optional<Outcome> difference_of_studies(const StudyDraw& draw) {
  const auto estimate = [&](double mean) {
    const auto of = analysis::mean_share(sample_of(mean, Trials::equal, draw));
    return analysis::IntervalEstimate{of->mean, of->interval.value(), of->participants - 1.0};
  };
  const auto first = estimate(0.6);
  return holds(analysis::independent_difference(first, estimate(0.8)).interval, 0.2);
}

std::vector<double> shares_of(double mean, const StudyDraw& draw) {
  std::vector<double> shares;
  for (const auto& of : sample_of(mean, Trials::some_stop, draw)) {
    shares.push_back(of.value());
  }
  return shares;
}

// Within participants; a fifth lie beyond the highest level of one of two, or nobody.
std::vector<analysis::Interval> differences_of(double mean, double limit, const StudyDraw& draw) {
  std::vector<analysis::Interval> found;
  for (const double d : normal_values(draw.people, mean, 1.0, draw.rng)) {
    found.push_back(d < limit ? analysis::Interval{d, d} : analysis::Interval{limit, INFINITY});
  }
  return found;
}

std::optional<Outcome> censored_interval(const StudyDraw& draw) {
  const auto interval = analysis::censored_contrast(differences_of(0.5, 1.34, draw), 1).interval;
  return interval ? std::optional{holds(*interval, 0.5)} : std::nullopt;
}

std::optional<Outcome> paired_difference(const StudyDraw& draw) {
  std::vector<double> differences = shares_of(0.6, draw);
  const std::vector<double> others = shares_of(0.8, draw);
  std::ranges::transform(differences, others, differences.begin(), std::minus<>{});
  const auto interval = analysis::paired_contrast(differences, 1).interval;
  return interval ? std::optional{holds(*interval, -0.2)} : std::nullopt;
}

std::optional<Outcome> equivalence_p(const std::vector<double>& differences, double bound) {
  try {
    return Outcome{analysis::equivalence_test(differences, bound).p};
  } catch (const core::NotEstimable&) {  // all differences are equal
    return std::nullopt;
  }
}

std::vector<Row> rows_within() {
  using enum Kind;
  constexpr const char* task = "blocks compared";
  return {
      {coverage, task, "difference of shares .6 and .8, some stop", By::correlations,
       paired_difference},
      {coverage, task, "ratio, a fifth beyond the levels", By::people, censored_interval},
      {size, task, "signs of shares .6, some stop", By::correlations,
       [](const StudyDraw& draw) {
         std::vector<double> differences = shares_of(0.6, draw);
         const std::vector<double> others = shares_of(0.6, draw);
         std::ranges::transform(differences, others, differences.begin(), std::minus<>{});
         return std::optional{sign_flips_of(differences, draw.rng)};
       }},
      {size, task, "signs of ratios, a fifth beyond the levels", By::people,
       [](const StudyDraw& draw) {
         auto found = differences_of(0.0, 0.84, draw);  // on either side alike
         for (auto& one : found) {
           one = draw.rng.below(2) == 0 ? one : analysis::Interval{-one.high, -one.low};
         }
         return std::optional{Outcome{analysis::censored_contrast(found, 1).p}};
       }},
      {size, task, "equivalence of shares .7 and .8 within .1, some stop", By::correlations,
       [](const StudyDraw& draw) {
         std::vector<double> differences = shares_of(0.8, draw);
         const std::vector<double> others = shares_of(0.7, draw);
         std::ranges::transform(differences, others, differences.begin(), std::minus<>{});
         return equivalence_p(differences, 0.1);
       }},
      {size, task, "equivalence of normal values, at its bound of one SD", By::people,
       [](const StudyDraw& draw) {
         return equivalence_p(normal_values(draw.people, 1.0, 1.0, draw.rng), 1.0);
       }},
      {size, task, "interaction of two factors, of shares .6, some stop", By::correlations,
       [](const StudyDraw& draw) {
         std::vector<analysis::LevelTable> people(static_cast<std::size_t>(draw.people),
                                                  {{0.0, 0.0}, {0.0, 0.0}});
         for (const std::size_t row : {0U, 1U}) {
           for (const std::size_t column : {0U, 1U}) {
             const std::vector<double> shares = shares_of(0.6, draw);
             for (std::size_t i = 0; i < people.size(); ++i) {
               people[i][row][column] = shares[i];
             }
           }
         }
         std::vector<double> interactions;
         for (const analysis::LevelTable& own : people) {
           interactions.push_back(own[0][0] - own[0][1] - own[1][0] + own[1][1]);
         }
         return std::optional{Outcome{analysis::interaction_test(people, 1).p,
                                      share_further_by_signs(interactions, draw.rng)}};
       }},
      {coverage, "two studies compared", "difference of shares .6 and .8", By::correlations,
       difference_of_studies},
  };
}

using Sample = std::function<std::vector<double>(const StudyDraw&)>;
Row interval_of_groups(const char* words, double truth, const Sample& one, const Sample& other) {
  return {Kind::coverage, "groups compared, N each", words, By::people, [=](const StudyDraw& draw) {
            const auto first = one(draw);
            const auto interval = analysis::group_contrast(first, other(draw), 1).interval;
            return interval ? std::optional{holds(*interval, truth)} : std::nullopt;
          }};
}

Row test_of_groups(const char* words, const Sample& one, const Sample& other) {
  return {
      Kind::size, "groups compared, N each", words, By::people, [=](const StudyDraw& draw) {
        const auto first = one(draw);
        return std::optional{Outcome{analysis::group_permutation_test(first, other(draw), 1).p}};
      }};
}

Sample normal_of(double spread, int times) {
  return [=](const StudyDraw& draw) {
    return normal_values(times * draw.people, 0.0, spread, draw.rng);
  };
}

Sample shares_around(double mean) {
  return [=](const StudyDraw& draw) {
    StudyDraw of_different{draw.people, draw.rng};
    of_different.intraclass_correlation = 0.1;
    return shares_of(mean, of_different);
  };
}

std::vector<Row> rows_of_groups() {
  return {
      interval_of_groups("of normal values", 0.0, normal_of(1.0, 1), normal_of(1.0, 1)),
      interval_of_groups("2 N values, three times the spread", 0.0, normal_of(1.0, 1),
                         normal_of(3.0, 2)),
      interval_of_groups("shares .6 and .8, some stop", -0.2, shares_around(0.6),
                         shares_around(0.8)),
      test_of_groups("of normal values", normal_of(1.0, 1), normal_of(1.0, 1)),
      test_of_groups("2 N values, three times the spread", normal_of(1.0, 1), normal_of(3.0, 2)),
      test_of_groups("shares .6, some stop", shares_around(0.6), shares_around(0.6)),
      {Kind::size, "groups compared, N each", "ranks of ratios, a fifth beyond the levels",
       By::people,
       [](const StudyDraw& draw) {
         const auto first = differences_of(0.0, 0.84, draw);
         const auto scores = analysis::gehan_scores(first, differences_of(0.0, 0.84, draw));
         return std::optional{
             Outcome{analysis::group_permutation_test(scores.first, scores.second, 1).p}};
       }},
  };
}

std::optional<Outcome> exponent(const StudyDraw& draw) {
  std::vector<analysis::Estimates> people;
  for (int person = 0; person < draw.people; ++person) {
    const double own = 0.7 + 0.15 * draw.rng.normal();
    const double unit = draw.rng.log_normal(10.0, 0.8);
    people.emplace_back();
    for (const double value : {1.0, 2.0, 4.0, 8.0}) {
      people.back().push_back({value, unit * std::pow(value, own) * draw.rng.log_normal(1.0, 0.2)});
    }
  }
  return holds(analysis::power_law(people).exponent_interval.value(), 0.7);
}

std::optional<Outcome> bootstrap_of(const std::vector<double>& values, double truth) {
  const auto interval = analysis::bootstrap_interval(values, 999, 1);
  return interval ? std::optional{holds(*interval, truth)} : std::nullopt;
}

// A deviation of six settings is on average c4 of the person's own, which is log-normal.
std::optional<Outcome> mean_deviation(const StudyDraw& draw) {
  constexpr double c4_of_six = 0.9515329;
  std::vector<double> found;
  for (int person = 0; person < draw.people; ++person) {
    const double own = draw.rng.log_normal(1.0, 0.3);
    found.push_back(
        analysis::mean_and_spread(normal_values(6, 0.0, own, draw.rng)).standard_deviation);
  }
  return holds(analysis::positive_interval(found), c4_of_six * std::exp(0.045));
}

// Of each the mean d' = 1.5, by 15 signals and 15 others, with criteria of their own.
std::optional<Outcome> mean_sensitivity(const StudyDraw& draw) {
  const auto cdf = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  std::vector<double> found;
  for (const double own : normal_values(draw.people, 1.5, 0.5, draw.rng)) {
    const double bias = 0.3 * draw.rng.normal();
    found.push_back(analysis::yes_no_sensitivity(answered(cdf(0.5 * own - bias), 15, draw.rng),
                                                 answered(cdf(-0.5 * own - bias), 15, draw.rng))
                        .d_prime);
  }
  return holds(analysis::t_interval(found), 1.5);
}

// Values of two days: people differ by 1, days by .3, and .7 is left.
std::vector<std::vector<double>> days_of(const StudyDraw& draw) {
  std::vector<std::vector<double>> days(2);
  for (const double own : normal_values(draw.people, 0.0, 1.0, draw.rng)) {
    days[0].push_back(own + 0.7 * draw.rng.normal());
    days[1].push_back(own + 0.3 + 0.7 * draw.rng.normal());
  }
  return days;
}

std::optional<Outcome> upper_limit(const StudyDraw& draw) {
  const auto days = days_of(draw);
  const auto interval = analysis::limits_of_agreement(days[0], days[1]).high_interval;
  return interval ? std::optional{holds(*interval, 0.3 + 1.96 * 0.7 * std::sqrt(2.0))}
                  : std::nullopt;
}

// In absolute terms the shift counts as variance between days: .3 squared / 2.
std::optional<Outcome> agreement_of_days(const StudyDraw& draw) {
  const auto found = analysis::intraclass_correlation(days_of(draw));
  const double truth = 1.0 / (1.0 + 0.5 * 0.09 + 0.49);
  return found ? std::optional{holds(found->interval, truth)} : std::nullopt;
}

std::vector<Row> rows_of_personal_values() {
  using enum Kind;
  return {
      {coverage, "magnitude", "exponent", By::people, exponent},
      {coverage, "adjustment", "mean setting, by t", By::people,
       [](const StudyDraw& draw) {
         const auto values = normal_values(draw.people, 1.0, 1.0, draw.rng);
         return std::optional{holds(analysis::t_interval(values), 1.0)};
       }},
      {coverage, "adjustment", "mean setting, by bootstrap", By::people,
       [](const StudyDraw& draw) {
         return bootstrap_of(normal_values(draw.people, 1.0, 1.0, draw.rng), 1.0);
       }},
      {coverage, "adjustment", "mean deviation of 6 settings", By::people, mean_deviation},
      {coverage, "adjustment, times", "mean of skewed values above 0", By::people,
       [](const StudyDraw& draw) {
         return std::optional{holds(
             analysis::positive_interval(skewed_values(draw.people, draw.rng)), std::exp(0.125))};
       }},
      {coverage, "adjustment, times", "mean of normal values above 0", By::people,
       [](const StudyDraw& draw) {
         const auto values = normal_values(draw.people, 4.0, 1.0, draw.rng);
         return std::optional{holds(analysis::positive_interval(values), 4.0)};
       }},
      {coverage, "adjustment", "mean of skewed settings, by bootstrap", By::people,
       [](const StudyDraw& draw) {
         return bootstrap_of(skewed_values(draw.people, draw.rng), std::exp(0.125));
       }},
      {size, "adjustment, equality", "no constant error", By::people,
       [](const StudyDraw& draw) {
         const auto values = normal_values(draw.people, 0.0, 1.0, draw.rng);
         return std::optional{sign_flips_of(values, draw.rng)};
       }},
      {coverage, "identification", "mean d' of a class", By::people, mean_sensitivity},
      {coverage, "retest", "limit of agreement of two days", By::people, upper_limit},
      {coverage, "retest", "intra-class correlation of two days", By::people, agreement_of_days},
  };
}
}  // namespace

std::vector<Row> rows_of_shares() {
  std::vector<Row> rows;
  for (const double mean : {0.5, 0.8, 0.9}) {
    rows.push_back(coverage_of_share(mean, Trials::equal, "16 trials"));
    rows.push_back(coverage_of_share(mean, Trials::some_stop, "30 trials, some stop at 6"));
    rows.push_back(coverage_of_share(mean, Trials::those_below_stop,
                                     "30 trials, those below the mean stop at 6"));
  }
  for (const double mean : {0.5, 0.8}) {
    rows.push_back(width_of_share(mean, Trials::equal, "16 trials"));
    rows.push_back(width_of_share(mean, Trials::some_stop, "30 trials, some stop at 6"));
  }
  return rows;
}

std::vector<Row> rows_of_means() {
  std::vector<Row> rows = rows_within();
  for (const auto& more : {rows_of_groups(), rows_of_personal_values()}) {
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}
}  // namespace tapstudy::bench
