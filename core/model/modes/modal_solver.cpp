#include "core/model/modes/modal_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/modes/block_lanczos.hpp"
#include "core/model/modes/shifted_factor.hpp"
#include "core/model/progress.hpp"
namespace tapstudy::core {
namespace {
// Aimed at, and accepted where many modes crowd below the shift so that refinement gains little.
constexpr double residual_limit = 1e-8;
constexpr double accepted_residual = 1e-6;
// However stiff the stiffest element is: above this, a mode is rejected. Rounding in the stiffest
// elements leaves a residual that is large beside a soft mode's own forces, yet small beside |K|:
// a backward error (Higham & Higham 1998). The frequency, a Rayleigh quotient, errs by its square.
constexpr double max_residual = 1e-2;
// Multiple of the rounding unit allowed for a solve and the subsequent products.
constexpr double rounding_steps = 8.0;
// Up to this size a dense solve takes milliseconds, and a basis for Lanczos (block_lanczos.cpp) may
// take up all of the space, in which nothing converges.
constexpr Eigen::Index dense_size = 240;
constexpr int max_modes = 1000;
constexpr int max_refinements = 4;

struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
  Eigen::MatrixXd elastic;   // K times the vectors
  Eigen::MatrixXd inertial;  // M times the vectors
};

// LAPACK's error grows with the stiffest and lightest element, so these vectors need refinement
// too.
RitzVectors lowest_dense(const StiffnessAndMass& matrices, int count) {
  const EigenPairs all =
      symmetric_eigenpairs(Eigen::MatrixXd{matrices.K}, Eigen::MatrixXd{matrices.M});
  const Eigen::Index guards = std::min<Eigen::Index>(count, all.values.size() - count);
  return {all.vectors.leftCols(count),
          [next = Eigen::MatrixXd{all.vectors.middleCols(count, guards)}] { return next; }};
}

// Rayleigh-Ritz: the modes within the span of some vectors, double ones and those at zero frequency
// included; to rounding P' M P = I and P' K P = diag(w²) (paper eq. 8).
Pairs modes_in_span(const StiffnessAndMass& matrices, const Eigen::MatrixXd& vectors) {
  const Eigen::MatrixXd elastic = matrices.stiffness() * vectors;
  const Eigen::MatrixXd inertial = matrices.mass() * vectors;
  const auto [values, mix] =
      symmetric_eigenpairs(vectors.transpose() * elastic, vectors.transpose() * inertial);
  return {values, vectors * mix, elastic * mix, inertial * mix};
}

// Makes the first component of at least half the largest magnitude positive.
void fix_signs(Eigen::MatrixXd& vectors) {
  for (auto column : vectors.colwise()) {
    const double half = 0.5 * column.cwiseAbs().maxCoeff();
    const auto leading =
        std::find_if(column.begin(), column.end(), [&](double x) { return std::abs(x) > half; });
    if (leading != column.end() && *leading < 0.0) {
      column = -column;
    }
  }
}

// An upper bound of the 2-norm of K.
double largest_row_sum(const SparseMatrix& lower) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(lower.rows());
  for (Eigen::Index column = 0; column < lower.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry{lower, column}; entry; ++entry) {
      sums[entry.row()] += std::abs(entry.value());
      sums[column] += entry.row() == column ? 0.0 : std::abs(entry.value());
    }
  }
  return sums.maxCoeff();
}

struct Residual {
  double found{0.0};
  double allowed{0.0};
  bool is_small() const { return found <= allowed; }
  bool is_accepted() const { return found <= std::max(allowed, accepted_residual); }
};

// |K x - w² M x| relative to |K x| + w² |M x|; the tolerance includes the rounding error, which
// grows with the ratio of the stiffest element to the softest mode.
// Rigid-body modes are excluded: they have no forces to compare with.
std::vector<Residual> residuals(const Pairs& pairs, int rigid_body_modes, double rounding_n_per_m) {
  std::vector<Residual> all;
  for (Eigen::Index i = rigid_body_modes; i < pairs.values.size(); ++i) {
    const Eigen::VectorXd inertial = pairs.values[i] * pairs.inertial.col(i);
    const double scale = pairs.elastic.col(i).norm() + inertial.norm();
    all.push_back(
        {(pairs.elastic.col(i) - inertial).norm() / scale,
         std::min(max_residual,
                  residual_limit + rounding_n_per_m * pairs.vectors.col(i).norm() / scale)});
  }
  return all;
}

Pairs lowest(const Pairs& pairs, Eigen::Index count) {
  return {pairs.values.head(count), pairs.vectors.leftCols(count), pairs.elastic.leftCols(count),
          pairs.inertial.leftCols(count)};
}

// The modes below the shift. If components of much higher modes remain in the lowest, subspace
// iteration removes them; the guard vectors suppress modes above the shift, which it would amplify.
Pairs refined(const StiffnessAndMass& matrices, const ShiftedFactor& factor,
              const RitzVectors& ritz, double rounding_n_per_m, const ProgressHook& progress) {
  Pairs pairs = modes_in_span(matrices, ritz.wanted);
  const auto is_good = [&] {
    return std::ranges::all_of(residuals(pairs, matrices.rigid_body_modes, rounding_n_per_m),
                               &Residual::is_small);
  };
  if (is_good()) {
    return pairs;
  }
  const Eigen::MatrixXd guards = ritz.guards();
  Eigen::MatrixXd vectors{ritz.wanted.rows(), ritz.wanted.cols() + guards.cols()};
  vectors << ritz.wanted, guards;
  int rounds = 0;
  const Eigen::Index count = ritz.wanted.cols();
  do {
    tell(progress, "refining");
    vectors = matrices.mass() * vectors;
    factor.solve_in_place(vectors);
    const Pairs all = modes_in_span(matrices, vectors);
    vectors = all.vectors;
    pairs = lowest(all, count);
  } while (++rounds < max_refinements && !is_good());
  return pairs;
}

double checked_worst(const std::vector<Residual>& all) {
  double worst = 0.0;
  for (const Residual& one : all) {
    if (!one.is_accepted()) {
      throw ModelError{
          fmt::format("modes: a mode has a residual of {:.1e} (at most {:.1e}): are some "
                      "elements too flat, or is the body, or what holds it, too soft beside its "
                      "stiffest element?",
                      one.found, std::max(one.allowed, accepted_residual))};
    }
    worst = std::max(worst, one.found);
  }
  return worst;
}
}  // namespace

Modes solve_modes(const StiffnessAndMass& matrices, double band_limit_hz,
                  const ProgressHook& progress) {
  const double band = 2.0 * std::numbers::pi * band_limit_hz;
  Stopwatch watch;
  tell(progress, "factorising");
  Modes modes;
  modes.factor = std::make_shared<const ShiftedFactor>(matrices, band * band);
  const ShiftedFactor& factor = *modes.factor;
  modes.counted_in_band = factor.eigenvalues_below();
  modes.factor_s = watch.lap_s();
  const int count = modes.counted_in_band;
  if (count > max_modes) {
    throw ModelError{
        fmt::format("modes: {} lie below the band limit, more than the {} that can be rendered "
                    "(lower band_limit_hz, or is the body too soft?)",
                    count, max_modes)};
  }
  const double rounding_n_per_m =
      rounding_steps * std::numeric_limits<double>::epsilon() * largest_row_sum(matrices.K);
  const Eigen::Index size = matrices.K.rows();
  const Eigen::MatrixXd none{size, 0};
  Pairs pairs{Eigen::VectorXd{0}, none, none, none};
  if (count > 0) {
    const bool is_small = size <= dense_size || Eigen::Index{4} * count > size;
    const RitzVectors ritz = is_small ? lowest_dense(matrices, count)
                                      : eigenvectors_below_shift(matrices, factor, count, progress);
    pairs = refined(matrices, factor, ritz, rounding_n_per_m, progress);
  }
  modes.rigid_body_modes = std::min(matrices.rigid_body_modes, count);
  modes.worst_residual = checked_worst(residuals(pairs, modes.rigid_body_modes, rounding_n_per_m));
  if (count > 0 && pairs.values.maxCoeff() >= band * band) {
    throw ModelError{fmt::format(
        "modes: {} lie below the band limit by the inertia count, but the solver missed "
        "one of them",
        count)};
  }
  const Eigen::Index kept = count - modes.rigid_body_modes;
  modes.omega_rad_s = pairs.values.tail(kept).array().sqrt();
  modes.shapes = pairs.vectors.rightCols(kept);
  modes.rigid_shapes = pairs.vectors.leftCols(modes.rigid_body_modes);
  fix_signs(modes.shapes);
  modes.iterate_s = watch.lap_s();
  return modes;
}
}  // namespace tapstudy::core
