#pragma once
#include "analysis/psychometric/binomial_likelihood.hpp"
namespace tapstudy::analysis {
// low = high holds a parameter fixed.
struct PsychometricBox {
  PsychometricVector low;
  PsychometricVector high;
};

struct Maximum {
  PsychometricVector at;
  double log_likelihood{};
};

// A local maximum of the likelihood within the box, from a start in it: Fisher scoring with
// Levenberg's damping; parameters at a bound that the score points out of rest.
Maximum climb(const BinomialLikelihood& likelihood, const PsychometricBox& box,
              const PsychometricVector& start);

// Which parameters are neither fixed nor at a bound.
Eigen::Array4i inner_parameters(const PsychometricBox& box, const PsychometricVector& at);
}  // namespace tapstudy::analysis
