#include "analysis/statistics/scaling/preference_scales.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/population/means.hpp"
#include "core/algebra/dense_solvers.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
// Reached from the first item by steps (i, j) that are not 0.
std::vector<bool> reached(const Eigen::MatrixXi& steps) {
  std::vector<bool> is_reached(static_cast<std::size_t>(steps.rows()), false);
  is_reached[0] = true;
  std::vector<Eigen::Index> open{0};
  while (!open.empty()) {
    const Eigen::Index from = open.back();
    open.pop_back();
    for (Eigen::Index to = 0; to < steps.cols(); ++to) {
      const auto place = static_cast<std::size_t>(to);
      if (steps(from, to) != 0 && !is_reached[place]) {
        is_reached[place] = true;
        open.push_back(to);
      }
    }
  }
  return is_reached;
}

std::vector<std::size_t> places(const std::vector<bool>& is_member, bool wanted) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < is_member.size(); ++i) {
    if (is_member[i] == wanted) {
      found.push_back(i + 1);
    }
  }
  return found;
}

void refuse_groups(const std::vector<std::size_t>& beating,
                   const std::vector<std::size_t>& beaten) {
  if (!beating.empty() && !beaten.empty()) {
    throw core::NotEstimable{fmt::format(
        "comparisons do not connect the items: of items {}, none was ever preferred to any of "
        "items {}, so no scale holds both; leave a group out or collect more comparisons",
        fmt::join(beaten, ", "), fmt::join(beating, ", "))};
  }
}

bool is_count_matrix(const Eigen::MatrixXi& counts, Eigen::Index items) {
  return counts.rows() == items && counts.cols() == items && (counts.array() >= 0).all() &&
         (counts.diagonal().array() == 0).all();
}
}  // namespace

PairedCounts sum(const std::vector<PairedCounts>& participants) {
  PairedCounts all;
  for (const PairedCounts& own : participants) {
    all.wins = all.wins.size() == 0 ? own.wins : Eigen::MatrixXi{all.wins + own.wins};
    all.ties = all.ties.size() == 0   ? own.ties
               : own.ties.size() == 0 ? all.ties
                                      : Eigen::MatrixXi{all.ties + own.ties};
  }
  return all;
}

void check_comparisons(const PairedCounts& counts, TiesConnect ties) {
  const Eigen::Index items = counts.items();
  if (items < 2 || !is_count_matrix(counts.wins, items)) {
    throw core::InvalidInput{
        "comparisons are a square matrix of counts of at least 0 with a diagonal of 0, of two "
        "items or more"};
  }
  const bool has_ties = counts.ties.size() != 0;
  if (has_ties &&
      (!is_count_matrix(counts.ties, items) || counts.ties != counts.ties.transpose())) {
    throw core::InvalidInput{
        "ties are a symmetric matrix of counts of at least 0 with a diagonal of 0, of as many "
        "items as the comparisons"};
  }
  Eigen::MatrixXi steps = counts.wins;
  if (has_ties && ties == TiesConnect::yes) {
    steps += counts.ties;
  }
  const std::vector<bool> below_first = reached(steps);
  refuse_groups(places(below_first, false), places(below_first, true));
  const std::vector<bool> above_first = reached(steps.transpose());
  refuse_groups(places(above_first, true), places(above_first, false));
}

namespace {
// Of a difference or a value, which the contrast gives. Not a number: unknown.
double variance_of(const PreferenceScale& scale, const Eigen::VectorXd& contrast) {
  const double least = contrast.dot(scale.least_covariance * contrast);
  const double own = contrast.dot(scale.covariance * contrast);
  return std::isnan(own) ? own : std::max(least, own);
}

Interval interval_of(double value, double standard_error, double freedom) {
  if (std::isnan(standard_error)) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {-infinity, infinity};
  }
  const double quantile = std::isinf(freedom) ? normal_quantile(0.975) : t_quantile(0.975, freedom);
  return {value - quantile * standard_error, value + quantile * standard_error};
}

double two_sided_p(double ratio, double freedom) {
  return std::isnan(ratio)     ? 1.0
         : std::isinf(freedom) ? normal_two_sided_p(ratio)
                               : f_p(ratio * ratio, 1.0, freedom);
}

// 1/m among the items' values: the projection on what differences do not determine.
Eigen::MatrixXd undetermined(Eigen::Index items, Eigen::Index parameters) {
  Eigen::MatrixXd projection = Eigen::MatrixXd::Zero(parameters, parameters);
  projection.topLeftCorner(items, items).setConstant(1.0 / static_cast<double>(items));
  return projection;
}
}  // namespace

ScaleDifference difference(const PreferenceScale& scale, Eigen::Index i, Eigen::Index j) {
  const Eigen::Index items = scale.values.size();
  if (i < 0 || j < 0 || i >= items || j >= items || i == j) {
    throw core::InvalidInput{
        fmt::format("a difference is between two of {} items, not {} and {}", items, i, j)};
  }
  ScaleDifference result;
  result.value = scale.values[i] - scale.values[j];
  Eigen::VectorXd contrast = Eigen::VectorXd::Unit(items, i);
  contrast[j] = -1.0;
  result.standard_error = std::sqrt(variance_of(scale, contrast));
  result.interval = interval_of(result.value, result.standard_error, scale.freedom);
  result.p = two_sided_p(result.value / result.standard_error, scale.freedom);
  return result;
}

ScaleMaximum maximise_scale(const ScaleLikelihood& likelihood, Eigen::Index items,
                            Eigen::Index parameters) {
  constexpr int max_iterations = 200;
  constexpr double smallest_step = 1e-10;
  const Eigen::MatrixXd projection = undetermined(items, parameters);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(parameters);
  LikelihoodAt here = likelihood(at);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Eigen::MatrixXd determined = here.information + projection;
    Eigen::VectorXd step = core::SymmetricFactors{determined}.solve(here.score);
    LikelihoodAt there = likelihood(at + step);
    while (!(there.value >= here.value) && step.cwiseAbs().maxCoeff() > smallest_step) {
      step *= 0.5;
      there = likelihood(at + step);
    }
    at += step;
    here = there;
    if (step.cwiseAbs().maxCoeff() <= smallest_step) {
      break;
    }
  }
  at.head(items).array() -= at.head(items).mean();
  const Eigen::MatrixXd determined = here.information + projection;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(parameters, parameters);
  return {at, core::SymmetricFactors{determined}.solve_columns(identity) - projection, here.value};
}

namespace {
// Over participants; not a number where one of them alone tells of an item.
Eigen::MatrixXd covariance_over(const std::vector<LikelihoodAt>& participants,
                                const Eigen::MatrixXd& projection) {
  const Eigen::Index parameters = projection.rows();
  Eigen::MatrixXd information = projection;
  for (const LikelihoodAt& own : participants) {
    information += own.information;
  }
  const auto n = static_cast<double>(participants.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(parameters, parameters);
  for (const LikelihoodAt& own : participants) {
    const core::SymmetricFactors of_others{information - own.information};
    constexpr double smallest = 1e-9;
    if (!(of_others.pivots().minCoeff() > smallest * of_others.pivots().maxCoeff())) {
      return Eigen::MatrixXd::Constant(parameters, parameters, std::nan(""));
    }
    const Eigen::VectorXd change = of_others.solve(own.score);
    covariance += (n - 1.0) / n * change * change.transpose();
  }
  return covariance;
}
}  // namespace

PreferenceScale scale_of(const ScaleMaximum& maximum,
                         const std::vector<ScaleLikelihood>& participants, Eigen::Index items) {
  PreferenceScale scale;
  scale.values = maximum.at.head(items);
  scale.covariance = maximum.covariance.topLeftCorner(items, items);
  scale.least_covariance = Eigen::MatrixXd::Zero(items, items);
  scale.log_likelihood = maximum.log_likelihood;
  if (participants.size() > 1) {
    std::vector<LikelihoodAt> people;
    std::ranges::transform(participants, std::back_inserter(people),
                           [&](const ScaleLikelihood& own) { return own(maximum.at); });
    scale.least_covariance = share_of_binomial * scale.covariance;
    scale.covariance =
        covariance_over(people, undetermined(items, maximum.at.size())).topLeftCorner(items, items);
    scale.freedom = static_cast<double>(people.size()) - 1.0;
  }
  for (Eigen::Index i = 0; i < items; ++i) {
    const double variance = variance_of(scale, Eigen::VectorXd::Unit(items, i));
    scale.intervals.push_back(interval_of(scale.values[i], std::sqrt(variance), scale.freedom));
  }
  return scale;
}

namespace {
// The model is log-linear: an answer's probability is proportional to exp(features . parameters).
struct Answer {
  Eigen::VectorXd features;
  double count{};
};

void add_pair(const std::array<Answer, 3>& answers, std::size_t kinds, const Eigen::VectorXd& at,
              LikelihoodAt& sum) {
  std::array<double, 3> weights{};
  double total_weight = 0.0;
  double total = 0.0;
  for (std::size_t a = 0; a < kinds; ++a) {
    weights[a] = std::exp(answers[a].features.dot(at));
    total_weight += weights[a];
    total += answers[a].count;
  }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(at.size());
  for (std::size_t a = 0; a < kinds; ++a) {
    const double p = weights[a] / total_weight;
    mean += p * answers[a].features;
    sum.value += answers[a].count > 0.0 ? answers[a].count * std::log(p) : 0.0;
    sum.score += (answers[a].count - total * p) * answers[a].features;
    sum.information += total * p * answers[a].features * answers[a].features.transpose();
  }
  sum.information -= total * mean * mean.transpose();
}

using LikelihoodOfCounts = LikelihoodAt (*)(const PairedCounts&, const Eigen::VectorXd&);

// Valid as long as the counts are.
ScaleLikelihood likelihood_by(LikelihoodOfCounts likelihood, const PairedCounts& counts) {
  return [likelihood, &counts](const Eigen::VectorXd& at) { return likelihood(counts, at); };
}

std::vector<ScaleLikelihood> likelihoods_by(LikelihoodOfCounts likelihood,
                                            const std::vector<PairedCounts>& participants) {
  std::vector<ScaleLikelihood> all;
  for (const PairedCounts& counts : participants) {
    all.push_back(likelihood_by(likelihood, counts));
  }
  return all;
}

// Parameters: the items' values, then ln nu if there are ties.
LikelihoodAt likelihood_of_bradley_terry(const PairedCounts& counts, const Eigen::VectorXd& at) {
  const Eigen::Index items = counts.items();
  const bool has_ties = at.size() > items;
  const auto unit = [&](Eigen::Index i) { return Eigen::VectorXd::Unit(at.size(), i); };
  LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(at.size()),
                   Eigen::MatrixXd::Zero(at.size(), at.size())};
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      std::array<Answer, 3> answers{
          Answer{unit(i), static_cast<double>(counts.wins(i, j))},
          Answer{unit(j), static_cast<double>(counts.wins(j, i))},
          Answer{0.5 * (unit(i) + unit(j)), static_cast<double>(counts.ties_of(i, j))}};
      if (has_ties) {
        answers[2].features[items] = 1.0;
      }
      add_pair(answers, has_ties ? 3 : 2, at, sum);
    }
  }
  return sum;
}
}  // namespace

BradleyTerry bradley_terry(const std::vector<PairedCounts>& participants) {
  const PairedCounts counts = sum(participants);
  check_comparisons(counts, TiesConnect::no);
  const Eigen::Index items = counts.items();
  const bool has_ties = counts.ties.size() != 0 && counts.ties.sum() > 0;
  const ScaleMaximum maximum = maximise_scale(likelihood_by(likelihood_of_bradley_terry, counts),
                                              items, has_ties ? items + 1 : items);
  return {scale_of(maximum, likelihoods_by(likelihood_of_bradley_terry, participants), items),
          has_ties ? std::exp(maximum.at[items]) : 0.0};
}

namespace {
void add_pair(double wins, double losses, double distance, const Eigen::VectorXd& direction,
              LikelihoodAt& sum) {
  constexpr double smallest_p = 1e-300;
  const double p = std::max(smallest_p, normal_cdf(distance));
  const double q = std::max(smallest_p, normal_cdf(-distance));
  const double density = normal_density(distance);
  sum.value += wins * std::log(p) + losses * std::log(q);
  sum.score += density * (wins / p - losses / q) * direction;
  // the expected information (Fisher scoring), as in a generalised linear model
  sum.information +=
      (wins + losses) * density * density / (p * q) * direction * direction.transpose();
}

LikelihoodAt likelihood_of_thurstone(const PairedCounts& counts, const Eigen::VectorXd& at) {
  const Eigen::Index items = counts.items();
  LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(items), Eigen::MatrixXd::Zero(items, items)};
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      const double half = 0.5 * counts.ties_of(i, j);
      Eigen::VectorXd direction = Eigen::VectorXd::Unit(items, i);
      direction[j] = -1.0;
      add_pair(counts.wins(i, j) + half, counts.wins(j, i) + half, at[i] - at[j], direction, sum);
    }
  }
  return sum;
}
}  // namespace

PreferenceScale thurstone_case_v(const std::vector<PairedCounts>& participants) {
  const PairedCounts counts = sum(participants);
  check_comparisons(counts, TiesConnect::yes);
  const Eigen::Index items = counts.items();
  return scale_of(maximise_scale(likelihood_by(likelihood_of_thurstone, counts), items, items),
                  likelihoods_by(likelihood_of_thurstone, participants), items);
}

Consistency consistency(const Eigen::MatrixXi& is_preferred) {
  const std::int64_t m = is_preferred.rows();
  const Eigen::MatrixXi each_pair_once =
      Eigen::MatrixXi::Ones(m, m) - Eigen::MatrixXi::Identity(m, m);
  if (m < 3 || is_preferred.cols() != m || (is_preferred.array() < 0).any() ||
      is_preferred + is_preferred.transpose() != each_pair_once) {
    throw core::InvalidInput{
        "a judge's preferences are a square matrix of three items or more, with 1 for exactly one "
        "direction of each pair and 0 for the other"};
  }
  Consistency result;
  result.circular_triads = m * (m - 1) * (m - 2) / 6;
  for (const int preferences : is_preferred.rowwise().sum().eval()) {
    result.circular_triads -= std::int64_t{preferences} * (preferences - 1) / 2;
  }
  result.most_possible = (m % 2 == 1 ? m * m * m - m : m * m * m - 4 * m) / 24;
  result.zeta =
      1.0 - static_cast<double>(result.circular_triads) / static_cast<double>(result.most_possible);
  return result;
}

namespace {
// Counts how often each item stood before each other.
PairedCounts pairs_of(const std::vector<Ranking>& rankings, std::size_t items) {
  const auto count = static_cast<Eigen::Index>(items);
  PairedCounts counts{Eigen::MatrixXi::Zero(count, count), {}};
  for (const Ranking& ranking : rankings) {
    for (std::size_t place = 0; place < ranking.size(); ++place) {
      for (std::size_t later = place + 1; later < ranking.size(); ++later) {
        ++counts.wins(static_cast<Eigen::Index>(ranking[place]),
                      static_cast<Eigen::Index>(ranking[later]));
      }
    }
  }
  return counts;
}

void add(const Ranking& ranking, const Eigen::VectorXd& at, LikelihoodAt& sum) {
  Eigen::VectorXd left = Eigen::VectorXd::Zero(at.size());  // worths of items not yet placed
  for (auto item = ranking.rbegin(); item != ranking.rend(); ++item) {
    const auto placed = static_cast<Eigen::Index>(*item);
    left[placed] = std::exp(at[placed]);
    const Eigen::VectorXd shares = left / left.sum();
    sum.value += std::log(shares[placed]);
    sum.score += Eigen::VectorXd::Unit(at.size(), placed) - shares;
    sum.information += Eigen::MatrixXd{shares.asDiagonal()} - shares * shares.transpose();
  }
}
}  // namespace

bool is_ranking(Ranking ranking, std::size_t items) {
  std::ranges::sort(ranking);
  Ranking all(items);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return ranking == all;
}

PreferenceScale plackett_luce(const std::vector<std::vector<Ranking>>& participants,
                              std::size_t items) {
  std::vector<Ranking> all;
  std::vector<ScaleLikelihood> likelihoods;
  const auto count = static_cast<Eigen::Index>(items);
  const auto likelihood_by = [count](const std::vector<Ranking>& rankings) {
    return [count, &rankings](const Eigen::VectorXd& at) {
      LikelihoodAt sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
      for (const Ranking& ranking : rankings) {
        add(ranking, at, sum);
      }
      return sum;
    };
  };
  for (const std::vector<Ranking>& own : participants) {
    for (const Ranking& ranking : own) {
      if (!is_ranking(ranking, items)) {
        throw core::InvalidInput{"a ranking holds every item once"};
      }
      all.push_back(ranking);
    }
    likelihoods.emplace_back(likelihood_by(own));
  }
  check_comparisons(pairs_of(all, items), TiesConnect::no);
  return scale_of(maximise_scale(likelihood_by(all), count, count), likelihoods, count);
}
}  // namespace tapstudy::analysis
