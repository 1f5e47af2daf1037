#pragma once
#include "analysis/statistics/psychometric/likelihood.hpp"
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

// The nearest point of the box.
PsychometricVector inside(const PsychometricBox& box, const PsychometricVector& at);

// A climb to a local maximum of the likelihood within the box: Fisher scoring with Levenberg's
// damping, until a step gains less of the log-likelihood; parameters at a bound that the score
// points out of rest. Likelihood and box must outlive it.
class Climb {
 public:
  Climb(const BinomialLikelihood& likelihood, const PsychometricBox& box,
        const PsychometricVector& start, double smallest_gain);
  // So many steps, or as many as there are.
  void advance(int steps);
  void finish();
  Maximum best() const { return {at_, here_.log_likelihood}; }

 private:
  void step();

  const BinomialLikelihood* likelihood_;
  const PsychometricBox* box_;
  double smallest_gain_;
  PsychometricVector at_;
  BinomialLikelihood::Slopes here_;
  double damping_{1e-3};
  bool is_over_{false};
};

// Where a climb from a start in the box ends.
Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start, double smallest_gain = 1e-12);
// The same to ten digits, by its score: a likelihood is so flat there that its values tell seven.
Maximum refined(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                const Maximum& rough);
}  // namespace tapstudy::analysis
