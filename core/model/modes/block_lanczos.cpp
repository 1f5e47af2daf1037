#include "core/model/modes/block_lanczos.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/algebra/blas.hpp"
#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::core {
namespace {
using Eigen::Index;
using Eigen::MatrixXd;
constexpr std::uint64_t start_seed = 1;
constexpr Index max_block = 4;
constexpr double tolerance = 1e-10;  // of a Ritz pair's residual, relative to its nu
constexpr double well_apart = 1e-5;  // least Cholesky pivot, relative to the column's norm
constexpr double dependent = 1e-12;  // relative remainder of a linearly dependent column

// A matrix that grows block by block.
class GrowingColumns {
 public:
  auto all() const { return storage_.leftCols(used_); }
  Index count() const { return used_; }
  void append(const MatrixXd& more) {
    if (used_ + more.cols() > storage_.cols()) {
      storage_.conservativeResize(more.rows(), 2 * (used_ + more.cols()));
    }
    storage_.middleCols(used_, more.cols()) = more;
    used_ += more.cols();
  }

 private:
  MatrixXd storage_;
  Index used_{0};
};

// Vectors together with their product with the mass matrix, so that M inner products cost no more
// than ordinary ones.
struct Weighted {
  MatrixXd vectors;
  MatrixXd times_mass;
};
struct Basis {
  GrowingColumns vectors;
  GrowingColumns times_mass;
};

class BlockKrylov {
 public:
  BlockKrylov(const StiffnessAndMass& matrices, const ShiftedFactor& factor, Index block)
      : matrices_{matrices}, factor_{factor}, block_{block}, rng_{start_seed} {
    next_.vectors.resize(matrices.K.rows(), block);
    for (double& value : next_.vectors.reshaped()) {
      value = rng_.normal();
    }
    coupling_ = orthonormalise(next_);
  }

  Index size() const { return basis_.vectors.count(); }
  MatrixXd combined(const MatrixXd& weights) const {
    return combination(basis_.vectors.all(), weights);
  }

  // Appends the next block to the basis and prepares the one after it.
  void grow() {
    const Index before = size();
    basis_.vectors.append(next_.vectors);
    basis_.times_mass.append(next_.times_mass);
    projected_.conservativeResize(before + block_, before + block_);
    projected_.rightCols(block_).setZero();
    next_.vectors = next_.times_mass;
    factor_.solve_in_place(next_.vectors);
    project_out_of_next(std::min(size(), 2 * block_));
    project_out_of_next(size());
    projected_.bottomRows(block_) = projected_.rightCols(block_).transpose().eval();
    coupling_ = orthonormalise(next_);
  }

  // Empty unless all have converged.
  struct Converged {
    MatrixXd wanted;
    MatrixXd guard_weights;
  };
  Converged converged(Index count, double sigma) const {
    const EigenPairs ritz = symmetric_eigenpairs(0.5 * (projected_ + projected_.transpose()));
    const auto nu = ritz.values.head(count).array();
    const MatrixXd beyond = coupling_ * ritz.vectors.leftCols(count).bottomRows(block_);
    const bool all = (nu < 0.0).all() &&
                     (beyond.colwise().norm().transpose().array() <= tolerance * nu.abs()).all();
    if (!all) {
      return {};
    }
    const Index guards = (ritz.values.array() > 1.0 / sigma).count();
    // one step of inverse iteration at no cost: the component outside the basis is known
    return {combined(ritz.vectors.leftCols(count)) +
                next_.vectors * (beyond * nu.inverse().matrix().asDiagonal()),
            ritz.vectors.rightCols(guards)};
  }

 private:
  // In exact arithmetic the image of the last block overlaps only the last two blocks (Lanczos);
  // full reorthogonalisation keeps rounding errors from growing.
  void project_out_of_next(Index latest) {
    const MatrixXd overlap =
        inner_products(basis_.times_mass.all().rightCols(latest), next_.vectors);
    subtract_combination(basis_.vectors.all().rightCols(latest), overlap, next_.vectors);
    projected_.bottomRightCorner(latest, block_) += overlap;
  }
  void weigh(Weighted& block) const { block.times_mass = matrices_.mass() * block.vectors; }

  // Makes the block M-orthonormal and returns the factor R of W = Q R: by CholeskyQR2 (Yamamoto et
  // al. 2015), or column by column if the columns are nearly linearly dependent.
  MatrixXd orthonormalise(Weighted& block) {
    MatrixXd triangle = MatrixXd::Identity(block_, block_);
    weigh(block);
    for (int pass = 0; pass < 2; ++pass) {
      const MatrixXd gram = inner_products(block.vectors, block.times_mass);
      const Eigen::VectorXd lengths = gram.diagonal().cwiseMax(0.0).cwiseSqrt();
      const Eigen::VectorXd scale = lengths.cwiseInverse();
      const Eigen::LLT<MatrixXd> factor{scale.asDiagonal() * gram * scale.asDiagonal()};
      const bool is_safe = scale.allFinite() && factor.info() == Eigen::Success &&
                           factor.matrixLLT().diagonal().minCoeff() > well_apart;
      if (!is_safe) {
        return column_by_column(block) * triangle;
      }
      const MatrixXd upper = MatrixXd{factor.matrixU()} * lengths.asDiagonal();
      for (MatrixXd* columns : {&block.vectors, &block.times_mass}) {
        upper.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(*columns);
      }
      triangle = upper * triangle;
    }
    return triangle;
  }
  // Gram-Schmidt. A linearly dependent column is replaced by a random one, with a zero diagonal
  // entry in R.
  MatrixXd column_by_column(Weighted& block) {
    MatrixXd& columns = block.vectors;
    MatrixXd triangle = MatrixXd::Zero(block_, block_);
    for (Index k = 0; k < block_; ++k) {
      const double original = length(columns.col(k));
      triangle.col(k).head(k) = project_out(columns, k);
      double left = length(columns.col(k));
      triangle(k, k) = left;
      if (!(left > dependent * original) || original == 0.0) {
        triangle(k, k) = 0.0;
        left = refill(columns, k);
      }
      columns.col(k) /= left;
    }
    weigh(block);
    return triangle;
  }
  double length(const Eigen::VectorXd& x) const { return std::sqrt(x.dot(matrices_.mass() * x)); }
  Eigen::VectorXd project_out(MatrixXd& columns, Index k) const {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(k);
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd weighted = matrices_.mass() * columns.col(k);
      const Eigen::VectorXd overlap = columns.leftCols(k).transpose() * weighted;
      columns.col(k) -= columns.leftCols(k) * overlap;
      weights += overlap;
    }
    return weights;
  }
  double refill(MatrixXd& columns, Index k) {
    for (double& value : columns.col(k)) {
      value = rng_.normal();
    }
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd overlap = basis_.times_mass.all().transpose() * columns.col(k);
      columns.col(k) -= basis_.vectors.all() * overlap;
      project_out(columns, k);
    }
    return length(columns.col(k));
  }

  const StiffnessAndMass& matrices_;
  const ShiftedFactor& factor_;
  Index block_;
  Rng rng_;
  Basis basis_;         // M-orthonormal
  MatrixXd projected_;  // basis' M (K - sigma M)^-1 M basis
  Weighted next_;       // M-orthonormal, orthogonal to the basis
  MatrixXd coupling_;   // component of the last block's image along next_
};
}  // namespace

RitzVectors eigenvectors_below_shift(const StiffnessAndMass& matrices, const ShiftedFactor& factor,
                                     int count, const ProgressHook& progress) {
  const Index size = matrices.K.rows();
  const Index block = std::clamp<Index>(count, 2, max_block);
  const Index most = std::min<Index>(size - block, 8 * Index{count} + 100 * block);
  const auto krylov = std::make_shared<BlockKrylov>(matrices, factor, block);
  Index next_look = Index{count} + 2 * block;
  while (krylov->size() + block <= most) {
    tell(progress, fmt::format("iterating, {} of at most {} vectors", krylov->size(), most));
    krylov->grow();
    if (krylov->size() >= next_look) {
      const auto found = krylov->converged(count, factor.sigma());
      if (found.wanted.cols() == count) {
        return {found.wanted,
                [krylov, weights = found.guard_weights] { return krylov->combined(weights); }};
      }
      next_look = krylov->size() + std::max(block, krylov->size() / 32);
    }
  }
  throw ModelError{
      fmt::format("modes: {} modes did not converge in a basis of {} vectors", count, most)};
}
}  // namespace tapstudy::core
