#pragma once
#include <Eigen/Core>
#include <vector>

#include "analysis/psychometric/levels.hpp"
namespace tapstudy::analysis {
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
    PsychometricVector score;
    Eigen::Matrix4d information;
  };
  double value(const PsychometricVector& at) const;
  Slopes slopes(const PsychometricVector& at) const;
  // F and psi at each level.
  std::vector<double> shape_values(const PsychometricVector& at) const;
  std::vector<double> proportions(const PsychometricVector& at) const;
  // 2 (log-likelihood of the observed proportions - value(at)) (Wichmann & Hill 2001a, eq. 5).
  double deviance(const PsychometricVector& at) const;

  double guess(const PsychometricVector& at) const {
    return rates_ == Rates::equal ? at[lapse_at] : at[guess_at];
  }

  const std::vector<Level>& levels() const { return levels_; }
  core::PsychometricShape shape() const { return shape_; }

 private:
  double shape_value(double x, double threshold, double log_slope) const;
  core::PsychometricShape shape_;
  std::vector<Level> levels_;
  Rates rates_;
};

// k ln p + (n - k) ln(1 - p), with 0 ln 0 = 0.
double binomial_log_likelihood(const Proportion& answers, double p);
}  // namespace tapstudy::analysis
