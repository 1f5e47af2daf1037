#include "core/model/elements/spring_support.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
namespace {
using Barycentric = Eigen::Vector3d;
using Corners = std::array<Barycentric, 3>;

// Minimum and maximum number of subdivisions of a triangle: the minimum finds regions that hold
// none of its nodes, the maximum is reached along a region's rim.
constexpr int least_divisions = 2;
constexpr int most_divisions = 6;

// Linear; quadratic with mid-side nodes of the edges 01 12 20; or cubic, with the functions of
// these edges, from the corner of the lower number, and of the face (TetElement<20>).
Eigen::VectorXd shape_functions(const Barycentric& at, const TetMesh::Indices& surface,
                                Eigen::Index triangle) {
  if (surface.cols() == 3) {
    return at;
  }
  Eigen::VectorXd shape(surface.cols());
  shape.head<3>() = at.array() * (2.0 * at.array() - 1.0);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Index j = (i + 1) % 3;
    shape[3 + i] = 4.0 * at[i] * at[j];
    if (surface.cols() == 10) {
      const double sign = surface(triangle, i) < surface(triangle, j) ? 1.0 : -1.0;
      shape[6 + i] = sign * at[i] * at[j] * (at[i] - at[j]);
      shape[9] = at.prod();
    }
  }
  return shape;
}

// Exact up to the fourth degree (Dunavant 1985, High degree efficient symmetrical Gaussian
// quadrature rules for the triangle): two orbits of three points.
struct Orbit {
  double weight;
  double major;
};
constexpr std::array<Orbit, 2> quadrature{Orbit{0.223381589678011, 0.108103018168070},
                                          Orbit{0.109951743655322, 0.816847572980459}};

// Integrates over the parts of one triangle that lie in the region.
class PartIntegral {
 public:
  PartIntegral(const TetMesh& mesh, Eigen::Index triangle, const SurfaceRegion& region)
      : region_{region}, surface_{mesh.surface} {
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
      corners_m_.col(corner) = mesh.nodes_m.row(mesh.surface(triangle, corner)).transpose();
    }
    part_.triangle = triangle;
    part_.products_m2 = Eigen::MatrixXd::Zero(surface_.cols(), surface_.cols());
    add({Barycentric::UnitX(), Barycentric::UnitY(), Barycentric::UnitZ()},
        triangle_area_m2(mesh, triangle), 0);
  }
  const TrianglePart& part() const { return part_; }

 private:
  bool holds(const Barycentric& at) const { return region_.holds(corners_m_ * at); }

  void add(const Corners& corners, double area_m2, int divisions) {
    const auto inside =
        std::ranges::count_if(corners, [this](const Barycentric& at) { return holds(at); });
    if (inside == 3) {  // the region is convex
      add_whole(corners, area_m2);
    } else if (divisions == most_divisions) {
      if (holds((corners[0] + corners[1] + corners[2]) / 3.0)) {
        add_whole(corners, area_m2);
      }
    } else if (inside > 0 || divisions < least_divisions) {
      divide(corners, area_m2, divisions);
    }
  }
  void divide(const Corners& corners, double area_m2, int divisions) {
    const auto& [a, b, c] = corners;
    const Barycentric ab = 0.5 * (a + b);
    const Barycentric bc = 0.5 * (b + c);
    const Barycentric ca = 0.5 * (c + a);
    for (const Corners& quarter :
         {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{ab, bc, ca}}) {
      add(quarter, 0.25 * area_m2, divisions + 1);
    }
  }
  void add_whole(const Corners& corners, double area_m2) {
    part_.area_m2 += area_m2;
    for (const Orbit& orbit : quadrature) {
      const double minor = 0.5 * (1.0 - orbit.major);
      for (std::size_t first = 0; first < 3; ++first) {
        const Barycentric at = orbit.major * corners.at(first) +
                               minor * (corners.at((first + 1) % 3) + corners.at((first + 2) % 3));
        const Eigen::VectorXd shape = shape_functions(at, surface_, part_.triangle);
        part_.products_m2 += orbit.weight * area_m2 * shape * shape.transpose();
      }
    }
  }

  const SurfaceRegion& region_;
  const TetMesh::Indices& surface_;
  Eigen::Matrix3d corners_m_;
  TrianglePart part_;
};
}  // namespace

std::vector<TrianglePart> parts_within(const TetMesh& mesh, const SurfaceRegion& region) {
  std::vector<TrianglePart> parts;
  for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
    const TrianglePart part = PartIntegral{mesh, triangle, region}.part();
    if (part.area_m2 > 0.0) {
      parts.push_back(part);
    }
  }
  return parts;
}

std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes) {
  const std::vector<bool> is_in = mesh.marked(nodes);
  const auto is_within = [&](int node) { return is_in[static_cast<std::size_t>(node)]; };
  std::map<Eigen::Index, double> weight_of;
  double whole_m2 = 0.0;
  // The integral of a quadratic shape function over its triangle is 0 for a corner and a third of
  // the area for a mid-side node; of a linear one a third of the area.
  const Eigen::Index first = mesh.order() == 2 ? 3 : 0;
  for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
    if (!std::ranges::all_of(mesh.surface.row(triangle), is_within)) {
      continue;
    }
    const double area_m2 = triangle_area_m2(mesh, triangle);
    whole_m2 += area_m2;
    for (Eigen::Index i = first; i < first + 3; ++i) {
      weight_of[mesh.surface(triangle, i)] += area_m2 / 3.0;
    }
  }
  std::vector<NodeWeight> weights;
  for (const auto& [node, area_m2] : weight_of) {
    weights.push_back({node, area_m2 / whole_m2});
  }
  if (weights.empty()) {
    for (const Eigen::Index node : nodes) {
      weights.push_back({node, 1.0 / static_cast<double>(nodes.size())});
    }
  }
  return weights;
}

namespace {
// K of two nodes, or of one.
class Coupling {
 public:
  Coupling(const FreeDofs& dofs, const Eigen::Vector3d& stiffness_n_per_m,
           Eigen::SparseMatrix<double>& K)
      : dofs_{dofs}, stiffness_n_per_m_{stiffness_n_per_m}, k_{K} {}

  void add(Eigen::Index row, Eigen::Index column, double share) const {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const int a = dofs_.position[static_cast<std::size_t>(3 * row + axis)];
      const int b = dofs_.position[static_cast<std::size_t>(3 * column + axis)];
      if (b >= 0 && a >= b && stiffness_n_per_m_[axis] > 0.0) {
        k_.coeffRef(a, b) += share * stiffness_n_per_m_[axis];
      }
    }
  }

 private:
  const FreeDofs& dofs_;
  const Eigen::Vector3d& stiffness_n_per_m_;
  Eigen::SparseMatrix<double>& k_;
};

void add_foundation(const TetMesh& mesh, const std::vector<TrianglePart>& parts,
                    const Coupling& coupling) {
  double whole_m2 = 0.0;
  for (const TrianglePart& part : parts) {
    whole_m2 += part.area_m2;
  }
  for (const TrianglePart& part : parts) {
    for (Eigen::Index i = 0; i < part.products_m2.cols(); ++i) {
      for (Eigen::Index j = 0; j < part.products_m2.cols(); ++j) {
        coupling.add(mesh.surface(part.triangle, i), mesh.surface(part.triangle, j),
                     part.products_m2(i, j) / whole_m2);
      }
    }
  }
}
}  // namespace

void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K) {
  for (const SpringSupport& support : supports) {
    const Coupling coupling{dofs, support.stiffness_n_per_m, K};
    const auto parts = parts_within(mesh, support.region);
    if (!parts.empty()) {
      add_foundation(mesh, parts, coupling);
      continue;
    }
    const std::vector<Eigen::Index>& nodes = support.region.nodes;
    for (const Eigen::Index node : nodes) {
      coupling.add(node, node, 1.0 / static_cast<double>(nodes.size()));
    }
  }
}
}  // namespace tapstudy::core
