#pragma once
#include <Eigen/Core>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "core/psychometric_function.hpp"
namespace tapstudy::analysis {
// The answers at one value of the stimulus: k of one kind ("correct", "stronger") in n.
struct Level {
  double value{};
  Proportion answers;
};

// Sorted by value, equal values put together, those without trials left out. Throws InvalidInput
// for counts that are not possible (0 <= k <= n), values that the shape does not allow (below 0 on
// a logarithmic axis), and fewer than two different values (above 0 on a logarithmic axis).
std::vector<Level> checked_levels(const std::vector<Level>& levels, core::PsychometricShape shape);

// The value on the shape's axis: itself or its logarithm to base 10, and back.
double on_axis(core::PsychometricShape shape, double value);
double from_axis(core::PsychometricShape shape, double position);

// The extent of the levels on the axis: the two outermost and the smallest distance between two
// that exceeds rounding. The levels are checked; a value of 0 on a logarithmic axis is left out.
struct AxisRange {
  double low{};
  double high{};
  double smallest_gap{};
  double length() const { return high - low; }
};
AxisRange axis_range(const std::vector<Level>& levels, core::PsychometricShape shape);

// The parameters of a psychometric function as they are fitted.
using PsychometricVector = Eigen::Vector4d;
enum PsychometricPlace : Eigen::Index { threshold_at, log_slope_at, guess_at, lapse_at };

// equal: guesses are lapses at the other end, so that the guess rate follows the lapse rate and
// does not count as a parameter.
enum class Rates { separate, equal };

// The log-likelihood of binomial answers (Wichmann & Hill 2001a, eq. 2, without the binomial
// coefficients), its score and expected information, as functions of the threshold on the shape's
// axis, ln slope, guess and lapse rate.
class BinomialLikelihood {
 public:
  // levels as checked_levels gives them
  BinomialLikelihood(core::PsychometricShape shape, std::vector<Level> levels,
                     Rates rates = Rates::separate);

  struct Slopes {
    double log_likelihood{};  // value(at)
    PsychometricVector score{PsychometricVector::Zero()};
    Eigen::Matrix4d information{Eigen::Matrix4d::Zero()};
  };
  double value(const PsychometricVector& at) const;
  Slopes slopes(const PsychometricVector& at) const;
  // F and psi at each level.
  std::vector<double> shape_values(const PsychometricVector& at) const;
  std::vector<double> proportions(const PsychometricVector& at) const;
  // The log-likelihood of the observed proportions.
  double saturated() const;
  // 2 (log-likelihood of the observed proportions - value(at)) (Wichmann & Hill 2001a, eq. 5).
  double deviance(const PsychometricVector& at) const;

  double guess(const PsychometricVector& at) const {
    return rates_ == Rates::equal ? at[lapse_at] : at[guess_at];
  }

  const std::vector<Level>& levels() const { return levels_; }
  core::PsychometricShape shape() const { return shape_; }

 private:
  core::PsychometricShape shape_;
  std::vector<Level> levels_;
  Rates rates_;
};

// k ln p + (n - k) ln(1 - p), with 0 ln 0 = 0.
double binomial_log_likelihood(const Proportion& answers, double p);

// The logarithm of the probability of k successes in n without the binomial coefficient, where the
// proportion itself varies from level to level by a beta distribution of mean p (Schütt et al.
// 2016, eq. 4 to 6): with nu = 1 / eta^2 - 1, B(k + nu p, n - k + nu (1 - p)) / B(nu p, nu (1 -
// p)). eta in [0, 1): 0 is binomial; the variance of the proportion is eta^2 p (1 - p).
double beta_binomial_log_likelihood(const Proportion& answers, double p, double eta);

// The same of all levels together, for many p and always the same eta: what depends on eta alone is
// computed once.
class BetaBinomialLikelihood {
 public:
  // levels: not copied. etas: above 0.
  BetaBinomialLikelihood(const std::vector<Level>& levels, const Eigen::ArrayXd& etas);
  // p: of each level. For each eta; valid until the next call.
  const Eigen::ArrayXd& log_likelihoods(const std::vector<double>& p);

 private:
  // Takes i from `from`, the answers of the other kind.
  void multiply(double mean, std::int64_t count, std::int64_t from);

  const std::vector<Level>& levels_;
  Eigen::ArrayXd nu_;                    // the sum of the beta distribution's parameters
  std::vector<Eigen::ArrayXd> inverse_;  // 1 / (nu + i), for i below the most trials of a level
  Eigen::ArrayXd product_;               // of the factors that are not in the sum yet
  Eigen::ArrayXd sum_;
};
}  // namespace tapstudy::analysis
