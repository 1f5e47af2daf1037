#include "analysis/statistics/psychometric/climb.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
namespace tapstudy::analysis {
PsychometricVector inside(const PsychometricBox& box, const PsychometricVector& at) {
  return at.cwiseMax(box.low).cwiseMin(box.high);
}

namespace {
bool is_held(const PsychometricBox& box, const PsychometricVector& at,
             const PsychometricVector& score, Eigen::Index i) {
  return box.low[i] == box.high[i] || (at[i] <= box.low[i] && score[i] <= 0.0) ||
         (at[i] >= box.high[i] && score[i] >= 0.0);
}

// The information where held parameters are as if known: their rows and columns are those of 1.
Eigen::Matrix4d remove_fixed_parameters(const BinomialLikelihood::Slopes& slopes,
                                        const PsychometricBox& box, const PsychometricVector& at,
                                        PsychometricVector& score) {
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

Climb::Climb(const BinomialLikelihood& likelihood, const PsychometricBox& box,
             const PsychometricVector& start, double smallest_gain)
    : likelihood_{&likelihood},
      box_{&box},
      smallest_gain_{smallest_gain},
      at_{inside(box, start)},
      here_{likelihood.slopes(at_)} {}

void Climb::advance(int steps) {
  for (int i = 0; i < steps && !is_over_; ++i) {
    step();
  }
}

void Climb::finish() {
  constexpr int max_iterations = 300;
  advance(max_iterations);
}

void Climb::step() {
  constexpr double most_damping = 1e12;
  constexpr double impossible = -std::numeric_limits<double>::infinity();
  PsychometricVector score;
  Eigen::Matrix4d information = remove_fixed_parameters(here_, *box_, at_, score);
  information.diagonal() *= 1.0 + damping_;
  information.diagonal().array() += 1e-12;
  const PsychometricVector next = inside(*box_, at_ + information.ldlt().solve(score));
  const BinomialLikelihood::Slopes there =
      next.allFinite() ? likelihood_->slopes(next)
                       : BinomialLikelihood::Slopes{.log_likelihood = impossible};
  if (there.log_likelihood >= here_.log_likelihood) {
    const double gain = there.log_likelihood - here_.log_likelihood;
    is_over_ = gain < smallest_gain_ && damping_ < 1.0;
    at_ = next;
    here_ = there;
    damping_ = std::max(1e-9, 0.1 * damping_);
  } else {
    damping_ = 10.0 * damping_;
    is_over_ = !(damping_ < most_damping);
  }
}

Maximum local_maximum(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                      const PsychometricVector& start, double smallest_gain) {
  Climb climb{likelihood, box, start, smallest_gain};
  climb.finish();
  return climb.best();
}

namespace {
// How the score falls as each parameter grows.
Eigen::Matrix4d observed_information(const BinomialLikelihood& likelihood,
                                     const PsychometricVector& at) {
  constexpr double h = 1e-5;
  Eigen::Matrix4d information;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const PsychometricVector ahead = likelihood.slopes(at + h * PsychometricVector::Unit(i)).score;
    const PsychometricVector behind = likelihood.slopes(at - h * PsychometricVector::Unit(i)).score;
    information.col(i) = (behind - ahead) / (2.0 * h);
  }
  return 0.5 * (information + information.transpose());
}
}  // namespace

// Newton's steps: those of Fisher's scoring may jump from one side of the maximum to the other.
Maximum refined(const BinomialLikelihood& likelihood, const PsychometricBox& box,
                const Maximum& rough) {
  PsychometricVector at = rough.at;
  constexpr int most_steps = 20;
  constexpr double shortest = 1e-12;
  double last_length = 1e-2;
  for (int i = 0; i < most_steps && last_length > shortest; ++i) {
    PsychometricVector score;
    BinomialLikelihood::Slopes slopes = likelihood.slopes(at);
    slopes.information = observed_information(likelihood, at);
    const Eigen::Matrix4d information = remove_fixed_parameters(slopes, box, at, score);
    const Eigen::LDLT<Eigen::Matrix4d> solver{information};
    const PsychometricVector step = solver.solve(score);
    if (!solver.isPositive() || !(step.norm() < last_length)) {
      break;
    }
    last_length = step.norm();
    at = inside(box, at + step);
  }
  return {at, likelihood.value(at)};
}
}  // namespace tapstudy::analysis
