#pragma once
#include <Eigen/Core>
#include <vector>
namespace tapstudy::analysis {
// Each row's column, no column twice, so that the sum of costs is least: the assignment problem by
// shortest augmenting paths (Jonker & Volgenant 1987). No more rows than columns, all costs finite.
std::vector<std::size_t> least_cost_assignment(const Eigen::MatrixXd& cost);
}  // namespace tapstudy::analysis
