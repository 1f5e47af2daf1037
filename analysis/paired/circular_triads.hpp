#pragma once
#include <Eigen/Core>
#include <cstdint>
namespace tapstudy::analysis {
// One judge's consistency (Kendall & Babington Smith 1940).
struct Consistency {
  std::int64_t circular_triads{};  // i over j, j over k, k over i
  std::int64_t most_possible{};    // (m^3 - m) / 24 of odd m, (m^3 - 4 m) / 24 of even
  double zeta{};                   // 1 - circular / most possible: 1 is consistent
};
// is_preferred(i, j) is 1 where i was preferred to j, else 0; of each pair exactly one. Circular
// triads are m (m - 1) (m - 2) / 6 - sum a_i (a_i - 1) / 2 with a_i preferences of item i. Throws
// InvalidInput for other matrices and fewer than three items.
Consistency consistency(const Eigen::MatrixXi& is_preferred);
}  // namespace tapstudy::analysis
