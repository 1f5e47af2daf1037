#include "core/model/modal_solver.hpp"

#include <Spectra/SymGEigsShiftSolver.h>
#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.hpp"
#include "core/model/inertia.hpp"
namespace tapstudy::core {
namespace {
constexpr double residual_limit = 1e-8;
constexpr double lanczos_tolerance = 1e-13;
constexpr int most_restarts = 1000;
// Below this fraction of the band a frequency is zero to rounding: a motion of the rigid body.
constexpr double rigid_fraction = 1e-4;
// Up to this size the whole spectrum costs nothing, and Lanczos would have no room.
constexpr Eigen::Index dense_size = 96;
constexpr int most_modes = 1000;

// The solver's view of (K - sigma M)^-1 with sigma < 0, which is positive definite even for a body
// that is free to move.
class ShiftedSolve {
 public:
  using Scalar = double;
  explicit ShiftedSolve(const StiffnessAndMass& matrices) : matrices_{matrices} {}
  Eigen::Index rows() const { return matrices_.K.rows(); }
  Eigen::Index cols() const { return matrices_.K.cols(); }
  void set_shift(double sigma) {
    factor_.cholmod().print = 0;  // what goes wrong is said below
    factor_.compute(matrices_.K - sigma * matrices_.M);
    if (factor_.info() != Eigen::Success) {
      throw ModelError{
          "modes: the stiffness matrix could not be factorised (is the body in one "
          "piece, are its properties in range?)"};
    }
  }
  void perform_op(const double* x_in, double* y_out) const {
    Eigen::Map<Eigen::VectorXd>{y_out, rows()} =
        factor_.solve(Eigen::Map<const Eigen::VectorXd>{x_in, rows()});
  }

 private:
  const StiffnessAndMass& matrices_;
  Eigen::CholmodSupernodalLLT<SparseMatrix> factor_;
};

class MassProduct {
 public:
  using Scalar = double;
  explicit MassProduct(const SparseMatrix& mass) : mass_{mass} {}
  Eigen::Index rows() const { return mass_.rows(); }
  Eigen::Index cols() const { return mass_.cols(); }
  void perform_op(const double* x_in, double* y_out) const {
    Eigen::Map<Eigen::VectorXd>{y_out, rows()}.noalias() =
        mass_ * Eigen::Map<const Eigen::VectorXd>{x_in, rows()};
  }

 private:
  const SparseMatrix& mass_;
};

struct Pairs {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

Pairs lowest_dense(const StiffnessAndMass& matrices, int count) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver{
      Eigen::MatrixXd{matrices.K}, Eigen::MatrixXd{matrices.M}};
  if (solver.info() != Eigen::Success) {
    throw ModelError{"modes: the dense eigenvalue solver did not converge"};
  }
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

Pairs lowest_by_lanczos(const StiffnessAndMass& matrices, int count, double shift) {
  ShiftedSolve solve{matrices};
  MassProduct mass{matrices.M};
  const int basis = std::min(static_cast<int>(matrices.K.rows()), std::max(2 * count, count + 20));
  Spectra::SymGEigsShiftSolver<ShiftedSolve, MassProduct, Spectra::GEigsMode::ShiftInvert> solver{
      solve, mass, count, basis, shift};
  solver.init();
  const Eigen::Index converged = solver.compute(Spectra::SortRule::LargestMagn, most_restarts,
                                                lanczos_tolerance, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful || converged < count) {
    throw ModelError{fmt::format("modes: only {} of {} modes converged in {} restarts", converged,
                                 count, most_restarts)};
  }
  return {solver.eigenvalues(), solver.eigenvectors()};
}

// M-orthonormal to rounding, double modes included: one pass of Gram-Schmidt in the mass metric.
void orthonormalise(Eigen::MatrixXd& vectors, const SparseMatrix& mass) {
  for (Eigen::Index i = 0; i < vectors.cols(); ++i) {
    const Eigen::VectorXd weighted = mass * vectors.col(i);
    const Eigen::VectorXd overlap = vectors.leftCols(i).transpose() * weighted;
    vectors.col(i) -= vectors.leftCols(i) * overlap;
    vectors.col(i) /= std::sqrt(vectors.col(i).dot(mass * vectors.col(i)));
  }
}

// The first component of at least half the largest size is positive.
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

// Of each mode, relative to the forces that it is the difference of; refused where it exceeds what
// rounding can leave there, which grows with the stiffest element over the softest mode.
double checked_residual(const StiffnessAndMass& matrices, const Modes& modes) {
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * matrices.K.norm();
  double worst = 0.0;
  for (Eigen::Index i = 0; i < modes.omega_rad_s.size(); ++i) {
    const auto shape = modes.shapes.col(i);
    const Eigen::VectorXd elastic = matrices.K * shape;
    const Eigen::VectorXd inertial =
        modes.omega_rad_s[i] * modes.omega_rad_s[i] * (matrices.M * shape);
    const double scale = elastic.norm() + inertial.norm();
    const double residual = (elastic - inertial).norm() / scale;
    const double allowed = residual_limit + rounding * shape.norm() / scale;
    if (!(residual <= allowed)) {
      throw ModelError{fmt::format("modes: mode {} has a residual of {:.1e} (at most {:.1e})",
                                   i + 1, residual, allowed)};
    }
    worst = std::max(worst, residual);
  }
  return worst;
}
}  // namespace

Modes solve_modes(const StiffnessAndMass& matrices, double band_limit_hz) {
  const double band = 2.0 * std::numbers::pi * band_limit_hz;
  Modes modes;
  modes.counted_in_band = eigenvalues_below(matrices, band * band);
  const int count = modes.counted_in_band;
  if (count > most_modes) {
    throw ModelError{
        fmt::format("modes: {} lie below {} Hz, more than the {} that a tick could "
                    "carry (lower band_limit_hz, or is the body too soft?)",
                    count, band_limit_hz, most_modes)};
  }
  const Eigen::Index size = matrices.K.rows();
  Pairs pairs{Eigen::VectorXd{0}, Eigen::MatrixXd{size, 0}};
  if (count > 0) {
    const double shift = -1e-2 * band * band;
    const bool is_small = size <= dense_size || Eigen::Index{2} * count > size;
    pairs = is_small ? lowest_dense(matrices, count) : lowest_by_lanczos(matrices, count, shift);
  }
  if (count > 0 && pairs.values.maxCoeff() >= band * band) {
    throw ModelError{
        fmt::format("modes: {} lie below {} Hz by the inertia count, but the solver "
                    "missed one of them",
                    count, band_limit_hz)};
  }
  const double zero = rigid_fraction * rigid_fraction * band * band;
  modes.rigid_body_modes = static_cast<int>((pairs.values.array() < zero).count());
  const Eigen::Index kept = count - modes.rigid_body_modes;
  orthonormalise(pairs.vectors, matrices.M);
  modes.omega_rad_s = pairs.values.tail(kept).array().sqrt();
  modes.shapes = pairs.vectors.rightCols(kept);
  fix_signs(modes.shapes);
  modes.worst_residual = checked_residual(matrices, modes);
  return modes;
}
}  // namespace tapstudy::core
