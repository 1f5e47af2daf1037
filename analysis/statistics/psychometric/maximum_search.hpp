#pragma once
#include <vector>

#include "analysis/statistics/psychometric/climb.hpp"
namespace tapstudy::analysis {
// The greatest maximum of a likelihood in a box, climbed to from a grid of starts, at the likeliest
// position for each slope and lapse rate: each may have a maximum of its own. The grid depends on
// the values of the levels alone, and is kept for other answers at them.
class MaximumSearch {
 public:
  MaximumSearch(const BinomialLikelihood& likelihood, const PsychometricBox& box);
  // likelihood: of the same levels, whatever the answers. Further starts lie in the box.
  Maximum maximum(const BinomialLikelihood& likelihood,
                  const std::vector<PsychometricVector>& further_starts = {}) const;
  // Whether the maximum is greater than that; ends with the first one that is.
  bool is_exceeded(const BinomialLikelihood& likelihood, double log_likelihood,
                   const PsychometricVector& start) const;

 private:
  void add(const PsychometricVector& at, const BinomialLikelihood& likelihood,
           const std::vector<double>& shape_values);
  std::vector<PsychometricVector> starts(const BinomialLikelihood& likelihood) const;
  Maximum rough_maximum(const BinomialLikelihood& likelihood,
                        const std::vector<PsychometricVector>& further_starts, double enough) const;

  PsychometricBox box_;
  std::vector<PsychometricVector> points_;
  Eigen::Index in_a_group_{};    // points of one slope and lapse rate
  Eigen::MatrixXd log_success_;  // of each point, for each level
  Eigen::MatrixXd log_failure_;
};
}  // namespace tapstudy::analysis
