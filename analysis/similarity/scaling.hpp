#pragma once
#include <vector>
namespace tapstudy::analysis {
// A map on which the distances between points are about those given.
struct ScaledMap {
  std::vector<std::vector<double>> points;  // points[i][dimension], around the origin
  std::vector<double> eigenvalues;          // of the dimensions, descending
  double explained{};  // their share of the sum of the absolute values of all eigenvalues
};
// Classical multidimensional scaling (Torgerson 1952; Gower 1966): eigenvectors of the doubly
// centred -d^2 / 2. The largest coordinate of a dimension is positive; dimensions whose eigenvalue
// is not above 0 have all points at 0. Throws InvalidInput for distances that are not a square,
// symmetric table of finite numbers not below 0 with a diagonal of 0, and dimensions outside 1 to
// the number of points.
ScaledMap classical_scaling(const std::vector<std::vector<double>>& distances, int dimensions);

// d_ij = -ln eta_ij (Shepard 1957), 0 for similarities above 1. Throws InvalidInput for a
// similarity that is not above 0.
std::vector<std::vector<double>> distances_of(const std::vector<std::vector<double>>& similarities);
}  // namespace tapstudy::analysis
