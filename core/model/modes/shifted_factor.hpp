#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
// The symmetric factors L D L' of K - sigma M, which give two things at once.
// The proof: by Sylvester's law of inertia as many eigenvalues of K x = lambda M x lie below sigma
// as D has negative pivots. And the solve that an eigenvalue iteration needs.
// By MUMPS (Amestoy et al. 2001): multifrontal, ordered against fill, pivoted where D is
// indefinite. Its library keeps global state: not for two threads at once.
class ShiftedFactor {
 public:
  // sigma in rad²/s². Throws ModelError if the matrix has no such factors or they need more memory
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
