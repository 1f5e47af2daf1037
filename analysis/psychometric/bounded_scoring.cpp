#include "analysis/psychometric/bounded_scoring.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
namespace tapstudy::analysis {
namespace {
constexpr int max_iterations = 300;
constexpr double smallest_gain = 1e-12;  // of the log-likelihood
constexpr double most_damping = 1e12;

bool is_held(const PsychometricBox& box, const PsychometricVector& at,
             const PsychometricVector& score, Eigen::Index i) {
  return box.low[i] == box.high[i] || (at[i] <= box.low[i] && score[i] <= 0.0) ||
         (at[i] >= box.high[i] && score[i] >= 0.0);
}

// The information where held parameters are as if known: their rows and columns are those of 1.
Eigen::Matrix4d without_held(const BinomialLikelihood::Slopes& slopes, const PsychometricBox& box,
                             const PsychometricVector& at, PsychometricVector& score) {
  Eigen::Matrix4d information = slopes.information;
  score = slopes.score;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (is_held(box, at, slopes.score, i)) {
      information.row(i).setZero();
      information.col(i).setZero();
      information(i, i) = 1.0;
      score[i] = 0.0;
    }
  }
  return information;
}
}  // namespace

Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start) {
  Maximum best{start.cwiseMax(box.low).cwiseMin(box.high), 0.0};
  best.log_likelihood = likelihood.value(best.at);
  double damping = 1e-3;
  for (int iteration = 0; iteration < max_iterations && damping < most_damping; ++iteration) {
    PsychometricVector score;
    Eigen::Matrix4d information = without_held(likelihood.slopes(best.at), box, best.at, score);
    information.diagonal() *= 1.0 + damping;
    information.diagonal().array() += 1e-12;
    const PsychometricVector step = information.ldlt().solve(score);
    const PsychometricVector next = (best.at + step).cwiseMax(box.low).cwiseMin(box.high);
    const double value =
        next.allFinite() ? likelihood.value(next) : -std::numeric_limits<double>::infinity();
    if (value >= best.log_likelihood) {
      const double gain = value - best.log_likelihood;
      best = {next, value};
      if (gain < smallest_gain && damping < 1.0) {
        break;
      }
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = 10.0 * damping;
    }
  }
  return best;
}

Maximum refined(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                const Maximum& rough) {
  PsychometricVector at = rough.at;
  constexpr int most_steps = 200;
  constexpr double shortest = 1e-12;
  double last_length = 1e-3;
  for (int i = 0; i < most_steps && last_length > shortest; ++i) {
    PsychometricVector score;
    Eigen::Matrix4d information = without_held(likelihood.slopes(at), box, at, score);
    information.diagonal().array() += 1e-12;
    const PsychometricVector step = information.ldlt().solve(score);
    if (!(step.norm() < last_length)) {
      break;
    }
    last_length = step.norm();
    at = (at + step).cwiseMax(box.low).cwiseMin(box.high);
  }
  return {at, likelihood.value(at)};
}
}  // namespace tapstudy::analysis
