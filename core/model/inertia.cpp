#include "core/model/inertia.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
// Eigen's door to CHOLMOD keeps the factor to itself; this one counts the signs in it. In
// CHOLMOD's simplicial L D L' column j starts with its pivot.
class SignedFactor : public Eigen::CholmodSimplicialLDLT<SparseMatrix> {
 public:
  int negative_pivots() const {
    const auto* const starts = static_cast<const int*>(m_cholmodFactor->p);
    const auto* const values = static_cast<const double*>(m_cholmodFactor->x);
    int negative = 0;
    for (std::size_t column = 0; column < m_cholmodFactor->n; ++column) {
      negative += values[starts[column]] < 0.0 ? 1 : 0;
    }
    return negative;
  }
};
}  // namespace

int eigenvalues_below(const StiffnessAndMass& matrices, double sigma) {
  SignedFactor factor;
  factor.cholmod().print = 0;  // what goes wrong is said below
  factor.compute(matrices.K - sigma * matrices.M);
  if (factor.info() != Eigen::Success) {
    throw ModelError{fmt::format("modes: K - {:.6g} M has no L D L' factor", sigma)};
  }
  return factor.negative_pivots();
}
}  // namespace tapstudy::core
