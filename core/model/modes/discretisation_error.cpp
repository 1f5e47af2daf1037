#include "core/model/modes/discretisation_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "core/algebra/blas.hpp"
#include "core/algebra/lapack.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::core {
namespace {
constexpr Eigen::Index max_beyond = 4;  // modes above the band that are followed, too
constexpr int rounds_beyond = 3;
constexpr int max_steps = 100;
constexpr double settled_share = 0.02;  // of the drop so far
constexpr double settled = 2e-4;        // of an eigenvalue
constexpr double independent = 1e-9;    // of a Gram matrix's eigenvalues

// Vectors and their products with K and M.
struct Block {
  Eigen::MatrixXd vectors;
  Eigen::MatrixXd elastic;
  Eigen::MatrixXd inertial;
  Block times(const Eigen::MatrixXd& mix) const {
    return {combination(vectors, mix), combination(elastic, mix), combination(inertial, mix)};
  }
};

Block block_of(const StiffnessAndMass& matrices, Eigen::MatrixXd vectors) {
  Eigen::MatrixXd elastic = matrices.stiffness() * vectors;
  Eigen::MatrixXd inertial = matrices.mass() * vectors;
  return {std::move(vectors), std::move(elastic), std::move(inertial)};
}

// The lowest `count` pairs within a span whose vectors may depend on one another.
EigenPairs lowest_in_span(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, Eigen::Index count) {
  const Eigen::VectorXd scale = M.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const EigenPairs gram = symmetric_eigenpairs(scale.asDiagonal() * M * scale.asDiagonal());
  const Eigen::Index kept = (gram.values.array() > independent).count();
  const Eigen::MatrixXd basis = scale.asDiagonal() * gram.vectors.rightCols(kept) *
                                gram.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
  const EigenPairs inner = symmetric_eigenpairs(basis.transpose() * K * basis);
  const Eigen::Index found = std::min(count, kept);
  return {inner.values.head(found), basis * inner.vectors.leftCols(found)};
}

Eigen::MatrixXd random_vectors(Eigen::Index rows, Eigen::Index columns) {
  Rng rng{20240517};
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return rng.uniform() - 0.5; });
}

// Approximations of the modes next above the shift.
Eigen::MatrixXd modes_beyond(const StiffnessAndMass& coarse, const Modes& modes) {
  const Eigen::Index size = coarse.K.rows();
  const Eigen::Index known = modes.shapes.cols() + modes.rigid_shapes.cols();
  const Eigen::Index count = std::min(max_beyond, size - known);
  Eigen::MatrixXd found = random_vectors(size, count);
  Eigen::MatrixXd all{size, known};
  all << modes.rigid_shapes, modes.shapes;
  const Eigen::MatrixXd inertial = coarse.mass() * all;
  for (int round = 0; round < rounds_beyond && count > 0; ++round) {
    found -= all * (inertial.transpose() * found);
    found = coarse.mass() * found;
    modes.factor->solve_in_place(found);
    found -= all * (inertial.transpose() * found);
    const EigenPairs pairs = lowest_in_span(found.transpose() * (coarse.stiffness() * found),
                                            found.transpose() * (coarse.mass() * found), count);
    found = found * pairs.vectors;
  }
  return found;
}

void append(const Block& more, Block& to) {
  const auto join = [](const Eigen::MatrixXd& next, Eigen::MatrixXd& all) {
    const Eigen::Index before = all.cols();
    all.conservativeResize(next.rows(), before + next.cols());
    all.rightCols(next.cols()) = next;
  };
  join(more.vectors, to.vectors);
  join(more.elastic, to.elastic);
  join(more.inertial, to.inertial);
}

// The unknowns of the larger space that no degree of freedom of the given one is.
std::vector<int> added_by(const EnrichedBody& larger) {
  std::vector<bool> is_given(static_cast<std::size_t>(larger.matrices.K.rows()), false);
  for (const int place : larger.place) {
    is_given[static_cast<std::size_t>(place)] = true;
  }
  std::vector<int> added;
  for (std::size_t i = 0; i < is_given.size(); ++i) {
    if (!is_given[i]) {
      added.push_back(static_cast<int>(i));
    }
  }
  return added;
}

// The rows and columns of a symmetric matrix of which the lower triangle is stored; ascending.
SparseMatrix principal_part(const SparseMatrix& lower, const std::vector<int>& rows) {
  std::vector<int> row_of(static_cast<std::size_t>(lower.rows()), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    row_of[static_cast<std::size_t>(rows[i])] = static_cast<int>(i);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const int column : rows) {
    for (SparseMatrix::InnerIterator entry{lower, column}; entry; ++entry) {
      const int row = row_of[static_cast<std::size_t>(entry.row())];
      if (row >= 0) {
        entries.emplace_back(row, row_of[static_cast<std::size_t>(column)], entry.value());
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(rows.size());
  SparseMatrix part(size, size);
  part.setFromTriplets(entries.begin(), entries.end());
  return part;
}

class LargerSpace {
 public:
  LargerSpace(const EnrichedBody& larger, const Modes& modes)
      : larger_{larger},
        factor_{*modes.factor},
        added_{added_by(larger)},
        lower_{principal_part(larger.matrices.K, added_)},
        diagonal_{lower_.diagonal()},
        rigid_{block_of(larger.matrices, larger.prolongation * modes.rigid_shapes)} {}

  Block prolonged(const Eigen::MatrixXd& vectors) const {
    return block_of(larger_.matrices, larger_.prolongation * vectors);
  }

  // Two directions for each residual: the step on what was added, and the given space's answer.
  Block corrections(const Eigen::MatrixXd& residual) const {
    Block both = block_of(larger_.matrices, smoothed(residual));
    Eigen::MatrixXd remaining = larger_.prolongation.transpose() * (residual - both.elastic);
    factor_.solve_in_place(remaining);
    append(prolonged(remaining), both);
    const Eigen::MatrixXd share = rigid_.inertial.transpose() * both.vectors;
    both.vectors -= rigid_.vectors * share;
    both.inertial -= rigid_.inertial * share;
    return both;
  }

 private:
  Eigen::MatrixXd smoothed(const Eigen::MatrixXd& residual) const {
    Eigen::MatrixXd part = residual(added_, Eigen::all);
    lower_.triangularView<Eigen::Lower>().solveInPlace(part);
    part = diagonal_.asDiagonal() * part;
    lower_.transpose().triangularView<Eigen::Upper>().solveInPlace(part);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(residual.rows(), residual.cols());
    all(added_, Eigen::all) = part;
    return all;
  }

  const EnrichedBody& larger_;
  const ShiftedFactor& factor_;
  std::vector<int> added_;
  SparseMatrix lower_;
  Eigen::VectorXd diagonal_;
  Block rigid_;
};

// The iteration: Ritz pairs, and the directions in which they last moved.
class LargerModes {
 public:
  explicit LargerModes(Block start) : ritz_{std::move(start)} {
    const EigenPairs pairs = lowest_in_span(inner_products(ritz_.vectors, ritz_.elastic),
                                            inner_products(ritz_.vectors, ritz_.inertial), count());
    values_ = pairs.values;
    first_ = values_;
    moved_ = Eigen::VectorXd::Zero(values_.size());
    ritz_ = ritz_.times(pairs.vectors);
    moving_.resize(static_cast<std::size_t>(count()));
    std::iota(moving_.begin(), moving_.end(), 0);
  }
  bool has_settled() const { return moving_.empty(); }
  const Eigen::VectorXd& values() const { return values_; }

  void step(const LargerSpace& space) {
    const Eigen::MatrixXd residual = ritz_.elastic - ritz_.inertial * values_.asDiagonal();
    Block next = space.corrections(residual(Eigen::all, moving_));
    if (direction_.vectors.cols() > 0) {
      append(direction_, next);
    }
    const EigenPairs pairs = best_in_span_with(next);
    direction_ = next.times(pairs.vectors.bottomRows(next.vectors.cols()));
    const Block kept = ritz_.times(pairs.vectors.topRows(count()));
    ritz_ = {kept.vectors + direction_.vectors, kept.elastic + direction_.elastic,
             kept.inertial + direction_.inertial};
    note_moving(pairs.values);
    values_ = pairs.values;
  }

 private:
  Eigen::Index count() const { return ritz_.vectors.cols(); }

  EigenPairs best_in_span_with(const Block& next) const {
    const Eigen::Index more = next.vectors.cols();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(count() + more, count() + more);
    Eigen::MatrixXd M = Eigen::MatrixXd::Identity(count() + more, count() + more);
    K.topLeftCorner(count(), count()) = values_.asDiagonal();
    K.bottomLeftCorner(more, count()) = inner_products(next.vectors, ritz_.elastic);
    M.bottomLeftCorner(more, count()) = inner_products(next.vectors, ritz_.inertial);
    K.bottomRightCorner(more, more) = inner_products(next.vectors, next.elastic);
    M.bottomRightCorner(more, more) = inner_products(next.vectors, next.inertial);
    K.triangularView<Eigen::StrictlyUpper>() = K.transpose();
    M.triangularView<Eigen::StrictlyUpper>() = M.transpose();
    return lowest_in_span(K, M, count());
  }

  // What is left of a drop, if steps go on to shrink as they do: of a material that hardly changes
  // its volume they are small from the beginning, and many.
  static double left_after(double moved, double moved_before) {
    constexpr double slowest = 0.99;
    const double shrinks = moved_before > 0.0 ? std::min(moved / moved_before, slowest) : 0.0;
    return std::max(1.0, shrinks / (1.0 - shrinks)) * moved;
  }

  void note_moving(const Eigen::VectorXd& values) {
    moving_.clear();
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const double moved = values_[i] - values[i];
      const double drop = first_[i] - values[i];
      if (left_after(moved, moved_[i]) > settled_share * drop + settled * values[i]) {
        moving_.push_back(i);
      }
      moved_[i] = moved;
    }
  }

  Block ritz_;
  Block direction_;
  Eigen::VectorXd values_;
  Eigen::VectorXd first_;
  Eigen::VectorXd moved_;  // in the last step
  std::vector<Eigen::Index> moving_;
};
}  // namespace

Eigen::ArrayXd frequencies_in_larger_space(const StiffnessAndMass& given, const Modes& modes,
                                           const EnrichedBody& larger,
                                           const ProgressHook& progress) {
  const Eigen::MatrixXd beyond = modes_beyond(given, modes);
  Eigen::MatrixXd start{given.K.rows(), modes.shapes.cols() + beyond.cols()};
  start << modes.shapes, beyond;
  const LargerSpace space{larger, modes};
  LargerModes found{space.prolonged(start)};
  for (int step = 0; step < max_steps && !found.has_settled(); ++step) {
    tell(progress, "estimating the error");
    found.step(space);
  }
  return found.values().array().max(0.0).sqrt();
}
}  // namespace tapstudy::core
