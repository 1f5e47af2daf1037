#pragma once
#include <vector>

#include "analysis/modal_identification/decay_model.hpp"
namespace tapstudy::analysis {
// One of several decays whose first poles are the same.
struct WeightedDecay {
  DecayModel model;
  DecayModel::State state;
  double weight{1.0};  // of its squares: 1 over the variance of a value of its spectrum
};

// Variable projection (Golub & Pereyra 1973, Kaufman's approximation) with Levenberg-Marquardt
// steps on the poles until the weighted sum of squares settles; true if it did. The first
// `shared` poles of all decays are the same and remain so; what each decay has of its own is
// eliminated from the normal equations decay by decay (Schur complement).
bool descend(std::vector<WeightedDecay>& decays, Eigen::Index shared);

// The Fisher information of the shared poles' Re s and Im s [1/s], everything else unknown, too.
Eigen::MatrixXd information_on_shared(const std::vector<WeightedDecay>& decays,
                                      Eigen::Index shared);
}  // namespace tapstudy::analysis
