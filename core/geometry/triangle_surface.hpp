#pragma once
#include <Eigen/Core>
namespace tapstudy::core {
// Triangles over points, normals outward (counter-clockwise from outside).
struct TriangleSurface {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Points points_m;
  Triangles triangles;
};
}  // namespace tapstudy::core
