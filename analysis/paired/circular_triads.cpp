#include "analysis/paired/circular_triads.hpp"

#include "core/error.hpp"
namespace tapstudy::analysis {
Consistency consistency(const Eigen::MatrixXi& is_preferred) {
  const std::int64_t m = is_preferred.rows();
  const Eigen::MatrixXi each_pair_once =
      Eigen::MatrixXi::Ones(m, m) - Eigen::MatrixXi::Identity(m, m);
  if (m < 3 || is_preferred.cols() != m || (is_preferred.array() < 0).any() ||
      is_preferred + is_preferred.transpose() != each_pair_once) {
    throw core::InvalidInput{
        "a judge's preferences are a square matrix of three items or more, with 1 for exactly one "
        "direction of each pair and 0 for the other"};
  }
  Consistency result;
  result.circular_triads = m * (m - 1) * (m - 2) / 6;
  for (const int preferences : is_preferred.rowwise().sum().eval()) {
    result.circular_triads -= std::int64_t{preferences} * (preferences - 1) / 2;
  }
  result.most_possible = (m % 2 == 1 ? m * m * m - m : m * m * m - 4 * m) / 24;
  result.zeta =
      1.0 - static_cast<double>(result.circular_triads) / static_cast<double>(result.most_possible);
  return result;
}
}  // namespace tapstudy::analysis
