#include "core/model/elements/spring_support.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>

#include "core/algebra/lapack.hpp"
#include "core/model/elements/assembly.hpp"
namespace tapstudy::core {
namespace {
using Barycentric = Eigen::Vector3d;

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

// Exact up to the sixth degree, that of the products of cubic functions (Dunavant 1985, High degree
// efficient symmetrical Gaussian quadrature rules for the triangle): all different orders of the
// coordinates of each row.
struct Orbit {
  double weight;
  std::array<double, 3> at;
};
constexpr std::array<Orbit, 3> quadrature{
    Orbit{0.116786275726379, {0.249286745170910, 0.249286745170910, 0.501426509658179}},
    Orbit{0.050844906370207, {0.063089014491502, 0.063089014491502, 0.873821971016996}},
    Orbit{0.082851075618374, {0.053145049844817, 0.310352451033784, 0.636502499121399}}};

// The integrals of N N^T over a triangle, N the shape functions of its nodes.
Eigen::MatrixXd products_m2(const TetMesh& mesh, Eigen::Index triangle) {
  const Eigen::Index functions = mesh.surface.cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(functions, functions);
  for (const Orbit& orbit : quadrature) {
    std::array<double, 3> at = orbit.at;  // ascending
    do {
      const Eigen::VectorXd shape =
          shape_functions(Eigen::Map<const Barycentric>{at.data()}, mesh.surface, triangle);
      sum += orbit.weight * shape * shape.transpose();
    } while (std::ranges::next_permutation(at).found);
  }
  return triangle_area_m2(mesh, triangle) * sum;
}
}  // namespace

std::vector<Eigen::Index> triangles_between(const TetMesh& mesh,
                                            const std::vector<Eigen::Index>& nodes) {
  const std::vector<bool> is_in = mesh.marked(nodes);
  std::vector<Eigen::Index> between;
  for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
    if (std::ranges::all_of(mesh.surface.row(triangle).head<3>(),
                            [&](int corner) { return is_in[static_cast<std::size_t>(corner)]; })) {
      between.push_back(triangle);
    }
  }
  return between;
}

std::vector<NodeWeight> mean_weights(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes) {
  std::map<Eigen::Index, double> weight_of;
  double whole_m2 = 0.0;
  // The integral of a quadratic shape function over its triangle is 0 for a corner and a third of
  // the area for a mid-side node; of a linear one a third of the area.
  const Eigen::Index first = mesh.order() == 2 ? 3 : 0;
  for (const Eigen::Index triangle : triangles_between(mesh, nodes)) {
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
// 1 and the coordinates of a place, from the middle of a region and relative to its size: any
// motion that does not deform it is linear in these.
class LinearFields {
 public:
  using Values = Eigen::Vector4d;
  using Moments = Eigen::Matrix4d;  // means of the products of these over a region

  LinearFields(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes)
      : mesh_{mesh}, middle_m_{mesh.nodes_m(nodes, Eigen::all).colwise().mean().transpose()} {
    const double reach_m = (mesh.nodes_m(nodes, Eigen::all).rowwise() - middle_m_.transpose())
                               .rowwise()
                               .norm()
                               .maxCoeff();
    size_m_ = reach_m > 0.0 ? reach_m : 1.0;
  }
  Values at(const Eigen::Vector3d& place_m) const {
    Values values;
    values << 1.0, (place_m - middle_m_) / size_m_;
    return values;
  }
  // Of each of the mesh's unknowns; 0 of hierarchic ones, which are no places.
  Eigen::MatrixXd at_nodes() const {
    const Eigen::Index places =
        mesh_.order() == 3 ? mesh_.tets.leftCols<10>().maxCoeff() + 1 : mesh_.nodes_m.rows();
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(mesh_.nodes_m.rows(), 4);
    for (Eigen::Index node = 0; node < places; ++node) {
      values.row(node) = at(mesh_.nodes_m.row(node).transpose()).transpose();
    }
    return values;
  }

 private:
  const TetMesh& mesh_;
  Eigen::Vector3d middle_m_;
  double size_m_{};
};

// The moments of the parts of surface triangles that lie in a region: exact for triangles that lie
// in it whole; of others what a bisection of their edges, to a 64th, finds inside.
class RegionMoments {
 public:
  RegionMoments(const TetMesh& mesh, const SurfaceRegion& region, const LinearFields& fields)
      : region_{region}, fields_{fields} {
    for (Eigen::Index triangle = 0; triangle < mesh.surface.rows(); ++triangle) {
      Corners corners;
      for (Eigen::Index i = 0; i < 3; ++i) {
        corners.at(static_cast<std::size_t>(i)) =
            mesh.nodes_m.row(mesh.surface(triangle, i)).transpose();
      }
      add(corners, triangle_area_m2(mesh, triangle), 0);
    }
  }
  double area_m2() const { return area_m2_; }
  // nullopt where it holds no part of a triangle, such as a point.
  std::optional<LinearFields::Moments> means() const {
    return area_m2_ > 0.0 ? std::optional<LinearFields::Moments>{sum_m2_ / area_m2_} : std::nullopt;
  }

 private:
  using Corners = std::array<Eigen::Vector3d, 3>;
  // The least number of divisions finds regions that hold none of a triangle's corners, the
  // greatest is reached along a region's rim.
  static constexpr int least_divisions = 2;
  static constexpr int most_divisions = 6;

  void add(const Corners& corners, double area_m2, int divisions) {
    const auto inside =
        std::ranges::count_if(corners, [this](const auto& at_m) { return region_.holds(at_m); });
    if (inside == 3) {  // the region is convex
      add_whole(corners, area_m2);
    } else if (divisions == most_divisions) {
      if (region_.holds((corners[0] + corners[1] + corners[2]) / 3.0)) {
        add_whole(corners, area_m2);
      }
    } else if (inside > 0 || divisions < least_divisions) {
      divide(corners, area_m2, divisions);
    }
  }
  void divide(const Corners& corners, double area_m2, int divisions) {
    const auto& [a, b, c] = corners;
    const Eigen::Vector3d ab = 0.5 * (a + b);
    const Eigen::Vector3d bc = 0.5 * (b + c);
    const Eigen::Vector3d ca = 0.5 * (c + a);
    for (const Corners& quarter :
         {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{ab, bc, ca}}) {
      add(quarter, 0.25 * area_m2, divisions + 1);
    }
  }
  // The integral of f f' over a triangle, f linear: A / 12 (sum of f_i f_i' + sum f_i sum f_i').
  void add_whole(const Corners& corners, double area_m2) {
    LinearFields::Values sum = LinearFields::Values::Zero();
    for (const Eigen::Vector3d& corner_m : corners) {
      const LinearFields::Values values = fields_.at(corner_m);
      sum += values;
      sum_m2_ += area_m2 / 12.0 * values * values.transpose();
    }
    sum_m2_ += area_m2 / 12.0 * sum * sum.transpose();
    area_m2_ += area_m2;
  }

  const SurfaceRegion& region_;
  const LinearFields& fields_;
  LinearFields::Moments sum_m2_{LinearFields::Moments::Zero()};
  double area_m2_{0.0};
};

}  // namespace

double area_within_m2(const TetMesh& mesh, const SurfaceRegion& region) {
  return RegionMoments{mesh, region, LinearFields{mesh, region.nodes}}.area_m2();
}

namespace {
// Of these nodes, those that none of the triangles has.
std::vector<Eigen::Index> alone(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes,
                                const std::vector<Eigen::Index>& triangles) {
  std::vector<Eigen::Index> of_triangles;
  for (const Eigen::Index triangle : triangles) {
    const auto row = mesh.surface.row(triangle);
    of_triangles.insert(of_triangles.end(), row.begin(), row.end());
  }
  const std::vector<bool> is_of_triangle = mesh.marked(of_triangles);
  std::vector<Eigen::Index> left;
  std::ranges::copy_if(nodes, std::back_inserter(left), [&](Eigen::Index node) {
    return !is_of_triangle[static_cast<std::size_t>(node)];
  });
  return left;
}

// What of a mesh springs hold: surface triangles, and nodes that none of these has.
struct Foundation {
  std::vector<Eigen::Index> triangles;
  std::vector<Eigen::Index> single;
  double share_of_single{};  // of the stiffness
};

Foundation foundation_of(const TetMesh& mesh, const std::vector<Eigen::Index>& nodes) {
  Foundation foundation{triangles_between(mesh, nodes), {}, 0.0};
  foundation.single = alone(mesh, nodes, foundation.triangles);
  foundation.share_of_single =
      static_cast<double>(foundation.single.size()) / static_cast<double>(nodes.size());
  return foundation;
}

std::vector<Eigen::Index> every(std::size_t step, const std::vector<Eigen::Index>& all) {
  std::vector<Eigen::Index> some;
  for (std::size_t i = 0; i < all.size(); i += step) {
    some.push_back(all[i]);
  }
  return some;
}

// Of one with more unknowns than these, a part that lies all over it and has no more.
Foundation thinned(const Foundation& whole, const TetMesh& mesh, std::size_t most_unknowns) {
  const auto of_triangle = static_cast<std::size_t>(mesh.surface.cols());
  const std::size_t unknowns = of_triangle * whole.triangles.size() + whole.single.size();
  const std::size_t step = (unknowns + most_unknowns - 1) / most_unknowns;
  return {every(step, whole.triangles), every(step, whole.single), whole.share_of_single};
}

// How a stiffness of 1, along any axis, is shared out over pairs of a mesh's unknowns.
SparseMatrix shares_of(const Foundation& foundation, const TetMesh& mesh) {
  double whole_m2 = 0.0;
  for (const Eigen::Index triangle : foundation.triangles) {
    whole_m2 += triangle_area_m2(mesh, triangle);
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (const Eigen::Index triangle : foundation.triangles) {
    const Eigen::MatrixXd shares =
        (1.0 - foundation.share_of_single) / whole_m2 * products_m2(mesh, triangle);
    for (Eigen::Index i = 0; i < shares.rows(); ++i) {
      for (Eigen::Index j = 0; j < shares.cols(); ++j) {
        entries.emplace_back(mesh.surface(triangle, i), mesh.surface(triangle, j), shares(i, j));
      }
    }
  }
  for (const Eigen::Index node : foundation.single) {
    entries.emplace_back(
        static_cast<int>(node), static_cast<int>(node),
        foundation.share_of_single / static_cast<double>(foundation.single.size()));
  }
  const auto size = static_cast<int>(mesh.nodes_m.rows());
  SparseMatrix shares(size, size);
  shares.setFromTriplets(entries.begin(), entries.end());
  return shares;
}

// The inverse on the fields that the nodes of a region tell apart: of a plane one, not those across
// it; of a single node, only the constant.
LinearFields::Moments inverse_of_told(const LinearFields::Moments& moments) {
  constexpr double told = 1e-9;
  const auto pairs = symmetric_eigenpairs(moments);
  LinearFields::Moments inverse = LinearFields::Moments::Zero();
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (pairs.values[i] > told) {
      inverse += pairs.vectors.col(i) * pairs.vectors.col(i).transpose() / pairs.values[i];
    }
  }
  return inverse;
}

// K becomes K + G' (S - S0) G, G taking from displacements their linear part as K weighs them, S0
// and S being the moments of K and those wanted. What is orthogonal to it by K stays, so that K
// holds the same nodes. It joins all pairs of them.
void correct_linear_part(const Eigen::MatrixXd& at_nodes, const LinearFields::Moments& wanted,
                         SparseMatrix& shares) {
  const Eigen::MatrixXd weighed = shares * at_nodes;
  const LinearFields::Moments held = at_nodes.transpose() * weighed;
  const Eigen::MatrixXd linear_part = weighed * inverse_of_told(held);
  std::vector<int> involved;
  for (int node = 0; node < static_cast<int>(linear_part.rows()); ++node) {
    if (!linear_part.row(node).isZero(0.0)) {
      involved.push_back(node);
    }
  }
  const Eigen::MatrixXd of_involved = linear_part(involved, Eigen::all);
  const Eigen::MatrixXd added = of_involved * (wanted - held) * of_involved.transpose();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < involved.size(); ++j) {
    for (std::size_t i = 0; i < involved.size(); ++i) {
      entries.emplace_back(involved[i], involved[j],
                           added(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  }
  SparseMatrix correction(shares.rows(), shares.cols());
  correction.setFromTriplets(entries.begin(), entries.end());
  shares += correction;
}

constexpr double little = 1e-3;

// The part of a foundation's stiffness that a thinned one has to take over, so that the rest of it
// has clearly less than the wanted moments along every linear field.
double share_taken_over(const LinearFields::Moments& wanted, const LinearFields::Moments& held) {
  constexpr double rounding = 1e-9;
  for (const double share : {0.01, 0.03, 0.1, 0.3, 0.9}) {
    const auto left = symmetric_eigenpairs(wanted - (1.0 - 0.5 * share) * held);
    if (left.values.minCoeff() > -rounding) {
      return share;
    }
  }
  return 1.0 - 0.5 * little;
}

// The foundation of a region's nodes, corrected such that its moments are those of the region
// itself, but for a little of its own where the region has no extent, so that it holds the same
// nodes. The pairs of many nodes would fill K: there a thinned foundation takes over a part of the
// stiffness, and is corrected for both.
SparseMatrix corrected_shares(const SurfaceRegion& region, const TetMesh& mesh) {
  constexpr double rounding = 1e-9;
  constexpr std::size_t most_in_pairs = 1500;  // 50 MB
  constexpr std::size_t thinned_to = 300;      // whose pairs cost little beside the other nodes
  const LinearFields fields{mesh, region.nodes};
  const Foundation foundation = foundation_of(mesh, region.nodes);
  SparseMatrix shares = shares_of(foundation, mesh);
  const Eigen::MatrixXd at_nodes = fields.at_nodes();
  const LinearFields::Moments held = at_nodes.transpose() * (shares * at_nodes);
  const auto of_region = RegionMoments{mesh, region, fields}.means();
  if (!of_region || (*of_region - held).norm() < rounding) {
    return shares;
  }
  const LinearFields::Moments wanted = held + (*of_region - held) / (1.0 + little);
  if (region.nodes.size() <= most_in_pairs) {
    correct_linear_part(at_nodes, wanted, shares);
    return shares;
  }
  const double taken_over = share_taken_over(wanted, held);
  SparseMatrix part = taken_over * shares_of(thinned(foundation, mesh, thinned_to), mesh);
  correct_linear_part(at_nodes, wanted - (1.0 - taken_over) * held, part);
  return (1.0 - taken_over) * shares + part;
}

// Of the lower triangle, along each axis.
void add_axes(const SparseMatrix& shares, const Eigen::Vector3d& stiffness_n_per_m,
              const FreeDofs& dofs, std::vector<Eigen::Triplet<double>>& entries) {
  for (Eigen::Index column = 0; column < shares.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator share{shares, column}; share; ++share) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const int a = dofs.position[static_cast<std::size_t>(3 * share.row() + axis)];
        const int b = dofs.position[static_cast<std::size_t>(3 * column + axis)];
        if (b >= 0 && a >= b && stiffness_n_per_m[axis] > 0.0) {
          entries.emplace_back(a, b, share.value() * stiffness_n_per_m[axis]);
        }
      }
    }
  }
}
}  // namespace

void add_springs(const TetMesh& mesh, const std::vector<SpringSupport>& supports,
                 const FreeDofs& dofs, Eigen::SparseMatrix<double>& K) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const SpringSupport& support : supports) {
    add_axes(corrected_shares(support.region, mesh), support.stiffness_n_per_m, dofs, entries);
  }
  if (!entries.empty()) {
    SparseMatrix springs(K.rows(), K.cols());
    springs.setFromTriplets(entries.begin(), entries.end());
    K += springs;
  }
}
}  // namespace tapstudy::core
