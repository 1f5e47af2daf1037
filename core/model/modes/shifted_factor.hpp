#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
// The symmetric factorisation L D L' of K - sigma M. It serves two purposes: by Sylvester's law of
// inertia the number of eigenvalues of K x = lambda M x below sigma equals the number of negative
// pivots of D; and it provides the solve required by a shift-invert eigenvalue iteration.
// Computed by MUMPS (Amestoy et al. 2001): multifrontal, fill-reducing ordering, pivoting for
// indefinite D. The library keeps global state and is not thread-safe.
class ShiftedFactor {
 public:
  // sigma in rad²/s². Throws ModelError if the matrix is singular or the factors need more memory
  // than the machine has.
  ShiftedFactor(const StiffnessAndMass& matrices, double sigma);
  ~ShiftedFactor();
  ShiftedFactor(const ShiftedFactor&) = delete;
  ShiftedFactor& operator=(const ShiftedFactor&) = delete;
  ShiftedFactor(ShiftedFactor&&) = delete;
  ShiftedFactor& operator=(ShiftedFactor&&) = delete;

  double sigma() const { return sigma_; }
  int eigenvalues_below() const;
  // Replaces each column b by the solution of (K - sigma M) x = b.
  void solve_in_place(Eigen::MatrixXd& columns) const;

 private:
  struct Mumps;
  double sigma_;
  std::unique_ptr<Mumps> mumps_;
};
}  // namespace tapstudy::core
