#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "analysis/statistics/proportion.hpp"
namespace tapstudy::analysis {
// Answers in comparisons of pairs among m items. Items are named in errors by their place from 1.
struct PairedCounts {
  Eigen::MatrixXi wins;  // m x m: (i, j) is how often i was preferred to j; zero diagonal
  Eigen::MatrixXi ties;  // m x m, symmetric, zero diagonal; 0 x 0 if ties were not allowed

  Eigen::Index items() const { return wins.rows(); }
  int ties_of(Eigen::Index i, Eigen::Index j) const { return ties.size() == 0 ? 0 : ties(i, j); }
};

// Of all participants, of the same items.
PairedCounts sum(const std::vector<PairedCounts>& participants);

enum class TiesConnect { no, yes };
// Throws InvalidInput for fewer than two items, matrices of other shapes, negative counts, and
// where the items fall into two groups of which no member of one was ever preferred to any of the
// other: their distance is then infinite or unknown (Ford 1957). With TiesConnect::yes a tie is a
// preference in both directions.
void check_comparisons(const PairedCounts& counts, TiesConnect ties);

// Items on an interval scale whose mean is 0. Of one participant the covariance is by the
// information, which takes answers as independent. Of n participants who differ, of whom these are
// a sample, it is by leaving out each of them, one step of Newton's from the maximum (Lipsitz, Dear
// & Zhao 1994):
//   (n - 1) / n sum d_i d_i^T,   d_i = (H - H_i)^-1 s_i
// with their scores s_i and informations H_i, which add up to H. No variance is taken for less than
// share_of_binomial of that by H, because few people may agree by chance. It is not a number where
// an item was judged by one of them alone; intervals are infinite then.
struct PreferenceScale {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;                               // rows and columns sum to 0
  Eigen::MatrixXd least_covariance;                         // of one participant 0
  double freedom{std::numeric_limits<double>::infinity()};  // n - 1 of n participants
  std::vector<Interval> intervals;  // 95 %, by t; of one participant values +- 1.96 standard errors
  double log_likelihood{};          // without multinomial coefficients
};

struct ScaleDifference {
  double value{};
  double standard_error{};
  Interval interval;  // 95 %
  double p{};         // two-sided, by Wald's test of no difference, or by t
};
// values[i] - values[j]. Throws InvalidInput unless i and j are two different items.
ScaleDifference difference(const PreferenceScale& scale, Eigen::Index i, Eigen::Index j);

// A log-likelihood with its score and information at a point.
struct LikelihoodAt {
  double value{};
  Eigen::VectorXd score;
  Eigen::MatrixXd information;
};
using ScaleLikelihood = std::function<LikelihoodAt(const Eigen::VectorXd&)>;

struct ScaleMaximum {
  Eigen::VectorXd at;
  Eigen::MatrixXd covariance;
  double log_likelihood{};
};
// The maximum of a concave likelihood of `items` scale values, which only their differences
// determine, and any further parameters after them: Newton's method with halved steps, values
// centred. The covariance is the inverse of the information among centred values.
ScaleMaximum maximise_scale(const ScaleLikelihood& likelihood, Eigen::Index items,
                            Eigen::Index parameters);

// The scale of the maximum of the sum of participants' likelihoods, with the intervals of its first
// `items` parameters.
PreferenceScale scale_of(const ScaleMaximum& maximum,
                         const std::vector<ScaleLikelihood>& participants, Eigen::Index items);

// Bradley & Terry 1952, Luce 1959, with ties after Davidson 1970. With values v,
//   P(i preferred to j) : P(j to i) : P(tie) = exp(v_i) : exp(v_j) : nu exp((v_i + v_j) / 2),
// so that without ties P(i to j) = 1 / (1 + exp(v_j - v_i)).
struct BradleyTerry {
  PreferenceScale scale;  // values are logarithms of the abilities
  double nu{};            // 0 without ties
};
// Maximum likelihood. Throws InvalidInput as check_comparisons does (ties do not connect: a nu that
// grows with the distance may explain them).
BradleyTerry bradley_terry(const std::vector<PairedCounts>& participants);

// Thurstone 1927, Case V, by maximum likelihood: P(i preferred to j) = Phi(v_i - v_j). The unit is
// the standard deviation of a difference of two impressions, sqrt 2 of that of one. A tie counts as
// half a preference in each direction. Throws InvalidInput as check_comparisons does (ties
// connect).
PreferenceScale thurstone_case_v(const std::vector<PairedCounts>& participants);

// One judge's consistency (Kendall & Babington Smith 1940).
struct Consistency {
  std::int64_t circular_triads{};  // i over j, j over k, k over i
  std::int64_t most_possible{};    // (m^3 - m) / 24 of odd m, (m^3 - 4 m) / 24 of even
  double zeta{};                   // 1 - circular / most possible: 1 is consistent
};
// is_preferred(i, j) is 1 where i was preferred to j, else 0; of each pair exactly one. Circular
// triads are m (m - 1) (m - 2) / 6 - sum a_i (a_i - 1) / 2 with a_i preferences of item i. Throws
// InvalidInput for other matrices and fewer than three items.
Consistency consistency(const Eigen::MatrixXi& is_preferred);

// Items by place, the best first: each of them once.
using Ranking = std::vector<std::size_t>;
bool is_ranking(Ranking ranking, std::size_t items);

// Luce 1959; Plackett 1975. With worths exp(v), each place goes to one of the items that are left,
// in proportion to its worth:
//   P(ranking) = product over places k of exp(v_k) / sum over places l >= k of exp(v_l).
// The scale by maximum likelihood, of each participant's rankings. Throws InvalidInput for fewer
// than two items, rankings that are not of every item once, and where the items fall into two
// groups of which no member of one ever stood before any of the other: their distance is infinite
// (Hunter 2004).
PreferenceScale plackett_luce(const std::vector<std::vector<Ranking>>& participants,
                              std::size_t items);
}  // namespace tapstudy::analysis
