#pragma once
#include <Eigen/Core>
#include <string_view>
namespace tapstudy::analysis {
// Answers in comparisons of pairs among m items. Items are named in errors by their place from 1.
struct PairedCounts {
  Eigen::MatrixXi wins;  // m x m: (i, j) is how often i was preferred to j; zero diagonal
  Eigen::MatrixXi ties;  // m x m, symmetric, zero diagonal; 0 x 0 if ties were not allowed

  Eigen::Index items() const { return wins.rows(); }
  int ties_of(Eigen::Index i, Eigen::Index j) const { return ties.size() == 0 ? 0 : ties(i, j); }
};

enum class TiesConnect { no, yes };
// Throws InvalidInput for fewer than two items, matrices of other shapes, negative counts, and
// where the items fall into two groups of which no member of one was ever preferred to any of the
// other: their distance is then infinite or unknown (Ford 1957). With TiesConnect::yes a tie is a
// preference in both directions.
void check_comparisons(const PairedCounts& counts, TiesConnect ties);
}  // namespace tapstudy::analysis
