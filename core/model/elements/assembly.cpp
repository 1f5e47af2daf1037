#include "core/model/elements/assembly.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "core/algebra/lapack.hpp"
#include "core/error.hpp"
#include "core/model/elements/tet_element.hpp"
#include "core/model/mesh/tet_mesh.hpp"
namespace tapstudy::core {
// Which nodes share an element: for each node, itself and its higher-numbered neighbours,
// ascending. The sparsity pattern of the lower triangles of K and M.
struct NodeGraph {
  std::vector<int> first;       // node j's list is neighbours[first[j]] … [first[j + 1])
  std::vector<int> neighbours;  // starts with j itself where j is in an element
  int place_of(int node, int neighbour) const;
};
NodeGraph node_graph(const TetMesh& mesh);

namespace {
struct ElementsOfNodes {
  std::vector<int> first;
  std::vector<int> elements;
};

ElementsOfNodes elements_of_nodes(const TetMesh& mesh) {
  ElementsOfNodes result;
  result.first.assign(static_cast<std::size_t>(mesh.nodes_m.rows()) + 1, 0);
  for (const int node : mesh.tets.reshaped()) {
    ++result.first[static_cast<std::size_t>(node) + 1];
  }
  for (std::size_t i = 1; i < result.first.size(); ++i) {
    result.first[i] += result.first[i - 1];
  }
  std::vector<int> next{result.first.begin(), result.first.end() - 1};
  result.elements.resize(static_cast<std::size_t>(mesh.tets.size()));
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    for (const int node : mesh.tets.row(tet)) {
      const int place = next[static_cast<std::size_t>(node)]++;
      result.elements[static_cast<std::size_t>(place)] = static_cast<int>(tet);
    }
  }
  return result;
}
}  // namespace

NodeGraph node_graph(const TetMesh& mesh) {
  const ElementsOfNodes around = elements_of_nodes(mesh);
  NodeGraph graph;
  graph.first.push_back(0);
  std::vector<int> seen_from(static_cast<std::size_t>(mesh.nodes_m.rows()), -1);
  for (int node = 0; node < mesh.nodes_m.rows(); ++node) {
    const auto start = static_cast<std::ptrdiff_t>(graph.neighbours.size());
    const auto own = static_cast<std::size_t>(node);
    for (int k = around.first[own]; k < around.first[own + 1]; ++k) {
      for (const int other : mesh.tets.row(around.elements[static_cast<std::size_t>(k)])) {
        int& seen = seen_from[static_cast<std::size_t>(other)];
        if (other >= node && seen != node) {
          seen = node;
          graph.neighbours.push_back(other);
        }
      }
    }
    std::sort(graph.neighbours.begin() + start, graph.neighbours.end());
    graph.first.push_back(static_cast<int>(graph.neighbours.size()));
  }
  return graph;
}

int NodeGraph::place_of(int node, int neighbour) const {
  const auto own = static_cast<std::size_t>(node);
  const auto begin = neighbours.begin() + first[own];
  const auto end = neighbours.begin() + first[own + 1];
  return static_cast<int>(std::lower_bound(begin, end, neighbour) - neighbours.begin());
}

namespace {
// Threshold for the squared participation of constrained nodes in a rigid-body motion, relative to
// that of all motions: far above rounding, far below a screw head on a plate.
constexpr double nothing_holds = 1e-14;

// One flag a degree of freedom: constrained, or on a spring.
std::vector<bool> resisted_dofs(const FreeDofs& dofs, const std::vector<SpringSupport>& springs) {
  std::vector<bool> resisted(dofs.position.size(), false);
  for (std::size_t i = 0; i < resisted.size(); ++i) {
    resisted[i] = dofs.position[i] < 0;
  }
  for (const SpringSupport& support : springs) {
    for (const Eigen::Index node : support.region.nodes) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (support.stiffness_n_per_m[axis] > 0.0) {
          resisted[static_cast<std::size_t>(3 * node + axis)] = true;
        }
      }
    }
  }
  return resisted;
}
}  // namespace

RigidMotions::RigidMotions(const TetMesh& mesh)
    : mesh_{mesh},
      middle_m_{mesh.nodes_m.colwise().mean().transpose()},
      size_m_{(mesh.nodes_m.rowwise() - middle_m_.transpose()).rowwise().norm().maxCoeff()} {}

Eigen::Matrix<double, 6, 1> RigidMotions::displacement(const Eigen::Vector3d& place_m,
                                                       Eigen::Index axis) const {
  const Eigen::Vector3d arm = (place_m - middle_m_) / size_m_;
  Eigen::Matrix<double, 6, 1> motion;
  motion << Eigen::Vector3d::Unit(axis), arm.cross(Eigen::Vector3d::Unit(axis));
  return motion;
}

Eigen::Matrix<double, 6, 6> RigidMotions::resisted(
    const FreeDofs& dofs, const std::vector<SpringSupport>& springs) const {
  const std::vector<bool> is_resisted = resisted_dofs(dofs, springs);
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (Eigen::Index node = 0; node < mesh_.nodes_m.rows(); ++node) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (is_resisted[static_cast<std::size_t>(3 * node + axis)]) {
        const auto motion = displacement(mesh_.nodes_m.row(node).transpose(), axis);
        sum += motion * motion.transpose();
      }
    }
  }
  return sum;
}

int unresisted(const Eigen::MatrixXd& resisted_motions) {
  const double threshold = nothing_holds * std::max(1.0, resisted_motions.trace());
  return static_cast<int>(
      (symmetric_eigenpairs(resisted_motions).values.array() < threshold).count());
}

namespace {
using Axes = std::array<int, 3>;

// The sparsity pattern of K and M, computed before assembly: positions are looked up once per pair
// of nodes, not once per entry.
class Pattern {
 public:
  Pattern(const TetMesh& mesh, const FreeDofs& dofs) : dofs_{dofs}, graph_{node_graph(mesh)} {
    stiffness_before_.reserve(graph_.neighbours.size());
    mass_before_.reserve(graph_.neighbours.size());
    for (int node = 0; node < mesh.nodes_m.rows(); ++node) {
      count_column(node);
    }
  }

  // NOLINTBEGIN(clang-analyzer-unix.Malloc): Eigen's own arrays, freed by their destructors
  StiffnessAndMass empty_matrices() const {
    StiffnessAndMass matrices{SparseMatrix(dofs_.count, dofs_.count),
                              SparseMatrix(dofs_.count, dofs_.count)};
    const auto nodes = static_cast<int>(graph_.first.size()) - 1;
    for (int node = 0; node < nodes; ++node) {
      add_columns(node, matrices);
    }
    matrices.K.finalize();
    matrices.M.finalize();
    return matrices;
  }

  // NOLINTEND(clang-analyzer-unix.Malloc)

  // Adds the 3 × 3 block coupling nodes row and column, row >= column.
  void add(int row, int column, const Eigen::Matrix3d& stiffness, double mass,
           StiffnessAndMass& to) const {
    const auto place = static_cast<std::size_t>(graph_.place_of(column, row));
    for (int b = 0; b < 3; ++b) {
      const int in_column = position(column, b);
      if (in_column < 0) {
        continue;
      }
      int next = to.K.outerIndexPtr()[in_column] + stiffness_before_[place];
      next -= row == column ? 0 : free_before(column, b);
      for (int a = row == column ? b : 0; a < 3; ++a) {
        if (position(row, a) >= 0) {
          to.K.valuePtr()[next++] += stiffness(a, b);
        }
      }
      if (position(row, b) >= 0) {
        to.M.valuePtr()[to.M.outerIndexPtr()[in_column] +
                        mass_before_[place].at(static_cast<std::size_t>(b))] += mass;
      }
    }
  }

 private:
  int position(int node, int axis) const {
    return dofs_.position[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)];
  }
  int free_before(int node, int axis) const {
    int count = 0;
    for (int a = 0; a < axis; ++a) {
      count += position(node, a) >= 0 ? 1 : 0;
    }
    return count;
  }
  void count_column(int node) {
    const auto own = static_cast<std::size_t>(node);
    int stiffness = 0;
    Axes mass{};
    for (int k = graph_.first[own]; k < graph_.first[own + 1]; ++k) {
      const int row = graph_.neighbours[static_cast<std::size_t>(k)];
      stiffness_before_.push_back(stiffness);
      mass_before_.push_back(mass);
      for (int a = 0; a < 3; ++a) {
        const int is_free = position(row, a) >= 0 ? 1 : 0;
        stiffness += is_free;
        mass.at(static_cast<std::size_t>(a)) += is_free;
      }
    }
  }
  void add_columns(int node, StiffnessAndMass& matrices) const {
    for (int b = 0; b < 3; ++b) {
      if (position(node, b) >= 0) {
        add_column(node, b, matrices);
      }
    }
  }
  // Inserts explicit zeros at the structural non-zeros, from the diagonal down.
  void add_column(int node, int axis, StiffnessAndMass& matrices) const {
    const int column = position(node, axis);
    const auto own = static_cast<std::size_t>(node);
    matrices.K.startVec(column);
    matrices.M.startVec(column);
    for (int k = graph_.first[own]; k < graph_.first[own + 1]; ++k) {
      const int row = graph_.neighbours[static_cast<std::size_t>(k)];
      for (int a = row == node ? axis : 0; a < 3; ++a) {
        if (position(row, a) >= 0) {
          matrices.K.insertBackByOuterInner(column, position(row, a)) = 0.0;
        }
      }
      if (position(row, axis) >= 0) {
        matrices.M.insertBackByOuterInner(column, position(row, axis)) = 0.0;
      }
    }
  }

  const FreeDofs& dofs_;
  NodeGraph graph_;
  // For each graph entry: the number of free degrees of freedom before it in its list.
  std::vector<int> stiffness_before_;
  std::vector<Axes> mass_before_;
};

TetCorners corners_of(const TetMesh& mesh, Eigen::Index tet) {
  TetCorners corners;
  for (Eigen::Index i = 0; i < 4; ++i) {
    corners.row(i) = mesh.nodes_m.row(mesh.tets(tet, i));
  }
  return corners;
}

// Of an unknown of an edge, whose function runs from the corner of the lower number: -1 where the
// element names the other corner first.
double sign_of(const TetMesh& mesh, Eigen::Index tet, Eigen::Index unknown) {
  constexpr Eigen::Index first_edge = 10;
  const Eigen::Index edge = unknown - first_edge;
  if (edge < 0 || edge >= static_cast<Eigen::Index>(tet_edges.size())) {
    return 1.0;
  }
  const auto& [from, to] = tet_edges.at(static_cast<std::size_t>(edge));
  return mesh.tets(tet, from) < mesh.tets(tet, to) ? 1.0 : -1.0;
}

template <int Nodes>
void orient_edges(const TetMesh& mesh, Eigen::Index tet, TetElement<Nodes>& element) {
  for (Eigen::Index i = 0; i < Nodes; ++i) {
    if (sign_of(mesh, tet, i) < 0.0) {
      element.stiffness.template middleRows<3>(3 * i) *= -1.0;
      element.stiffness.template middleCols<3>(3 * i) *= -1.0;
      element.mass.row(i) *= -1.0;
      element.mass.col(i) *= -1.0;
    }
  }
}

template <int Nodes>
void add_elements(const TetMesh& mesh, const Material& material, const Pattern& pattern,
                  StiffnessAndMass& matrices) {
  const ElasticStiffness elasticity{material};
  for (Eigen::Index tet = 0; tet < mesh.tets.rows(); ++tet) {
    if (!(tet_volume_m3(mesh, tet) > 0.0)) {
      throw ModelError{fmt::format("mesh: tetrahedron {} has no volume", tet)};
    }
    TetElement<Nodes> element =
        tet_element<Nodes>(corners_of(mesh, tet), elasticity, material.density_kg_per_m3);
    orient_edges<Nodes>(mesh, tet, element);
    for (Eigen::Index j = 0; j < Nodes; ++j) {
      for (Eigen::Index i = 0; i < Nodes; ++i) {
        if (mesh.tets(tet, i) >= mesh.tets(tet, j)) {
          pattern.add(mesh.tets(tet, i), mesh.tets(tet, j),
                      element.stiffness.template block<3, 3>(3 * i, 3 * j), element.mass(i, j),
                      matrices);
        }
      }
    }
  }
}

std::vector<int> first_of_node(const FreeDofs& dofs) {
  std::vector<int> first;
  for (std::size_t node = 0; node < dofs.position.size() / 3; ++node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (dofs.position[3 * node + axis] >= 0) {
        first.push_back(dofs.position[3 * node + axis]);
        break;
      }
    }
  }
  first.push_back(dofs.count);
  return first;
}
}  // namespace

FreeDofs free_dofs(const std::vector<bool>& held) {
  FreeDofs dofs;
  dofs.position.reserve(held.size());
  for (const bool is_held : held) {
    dofs.position.push_back(is_held ? -1 : dofs.count++);
  }
  return dofs;
}

StiffnessAndMass assemble(const TetMesh& mesh, const Material& material, const FreeDofs& dofs,
                          const std::vector<SpringSupport>& springs) {
  check_material(material);
  const Pattern pattern{mesh, dofs};
  StiffnessAndMass matrices = pattern.empty_matrices();
  if (mesh.order() == 3) {
    add_elements<20>(mesh, material, pattern, matrices);
  } else if (mesh.order() == 2) {
    add_elements<10>(mesh, material, pattern, matrices);
  } else {
    add_elements<4>(mesh, material, pattern, matrices);
  }
  matrices.first_of_node = first_of_node(dofs);
  add_springs(mesh, springs, dofs, matrices.K);
  matrices.resisted_motions = RigidMotions{mesh}.resisted(dofs, springs);
  matrices.rigid_body_modes = unresisted(matrices.resisted_motions);
  return matrices;
}
}  // namespace tapstudy::core
