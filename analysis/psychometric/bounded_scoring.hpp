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
Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start);
// The same to ten digits, by its score: a likelihood is so flat there that its values tell seven.
Maximum refined(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                const Maximum& rough);
}  // namespace tapstudy::analysis
