#include "core/model/shells/shell_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.hpp"
#include "core/model/shells/shell_element.hpp"
#include "core/model/shells/shell_elements.hpp"
#include "core/model/shells/triangulation.hpp"
namespace tapstudy::core {
namespace {
using Entries = std::vector<Eigen::Triplet<double>>;

// The height of a layer above the middle, of half of the thickness.
constexpr double height_of(int layer) {
  return layer - 1.0;
}

// What becomes of an unknown of a place once some of its nodes are held: a factor times an unknown
// that is left, or nothing.
struct Left {
  int unknown{-1};
  double factor{0.0};
};

// Of all unknowns of all places, in order.
class Supported {
 public:
  Supported(const std::vector<bool>& held, Eigen::Index places) : held_{held} {
    for (Eigen::Index place = 0; place < places; ++place) {
      const int first = count_;
      std::array<Left, shell_unknowns> unknowns;
      for (int axis = 0; axis < 2; ++axis) {
        leave(place, axis, unknowns.at(static_cast<std::size_t>(axis)),
              unknowns.at(static_cast<std::size_t>(3 + axis)));
      }
      if (held_layers(place, 2).empty()) {
        unknowns[2] = {count_++, 1.0};
      }
      if (count_ > first) {
        first_of_place_.push_back(first);
      }
      all_.insert(all_.end(), unknowns.begin(), unknowns.end());
    }
    first_of_place_.push_back(count_);
  }
  int count() const { return count_; }
  const std::vector<int>& first_of_place() const { return first_of_place_; }
  const Left& of(Eigen::Index place, int unknown) const {
    return all_.at(static_cast<std::size_t>(shell_unknowns * place + unknown));
  }

 private:
  std::vector<int> held_layers(Eigen::Index place, int axis) const {
    std::vector<int> layers_held;
    for (int layer = 0; layer < layers; ++layer) {
      if (held_.at(static_cast<std::size_t>(3 * node_at(place, layer) + axis))) {
        layers_held.push_back(layer);
      }
    }
    return layers_held;
  }
  // Where one layer at height h is held, the middle moves by -h times what bends.
  void leave(Eigen::Index place, int axis, Left& middle, Left& bending) {
    const std::vector<int> layers_held = held_layers(place, axis);
    if (layers_held.empty()) {
      middle = {count_++, 1.0};
      bending = {count_++, 1.0};
    } else if (layers_held.size() == 1) {
      bending = {count_++, 1.0};
      middle = {bending.unknown, -height_of(layers_held.front())};
    }
  }

  const std::vector<bool>& held_;
  std::vector<Left> all_;
  std::vector<int> first_of_place_;
  int count_{0};
};

SparseMatrix from_entries(const Entries& entries, Eigen::Index rows, Eigen::Index columns) {
  SparseMatrix matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Displacements along x and y are those of the middle and, in proportion to the height, what bends.
SparseMatrix displacements(const Supported& supported, Eigen::Index places) {
  Entries entries;
  const auto add = [&](Eigen::Index row, const Left& left, double share) {
    if (left.unknown >= 0 && share * left.factor != 0.0) {
      entries.emplace_back(static_cast<int>(row), left.unknown, share * left.factor);
    }
  };
  for (Eigen::Index place = 0; place < places; ++place) {
    for (int layer = 0; layer < layers; ++layer) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Index row = 3 * node_at(place, layer) + axis;
        add(row, supported.of(place, axis), 1.0);
        if (axis < 2) {
          add(row, supported.of(place, 3 + axis), height_of(layer));
        }
      }
    }
  }
  return from_entries(entries, 3 * node_at(places, 0), supported.count());
}

// Adds a triangle's matrices to the lower triangles of those of what is left.
void add_element(const ShellElements::Matrices& element, const std::vector<Left>& unknowns,
                 Entries& stiffness, Entries& mass) {
  for (std::size_t column = 0; column < unknowns.size(); ++column) {
    const auto [b, share_b] = unknowns[column];
    for (std::size_t row = 0; row < unknowns.size() && b >= 0; ++row) {
      const auto [a, share_a] = unknowns[row];
      if (a >= b && share_a * share_b != 0.0) {
        const auto i = static_cast<Eigen::Index>(row);
        const auto j = static_cast<Eigen::Index>(column);
        stiffness.emplace_back(a, b, share_a * share_b * element.stiffness(i, j));
        mass.emplace_back(a, b, share_a * share_b * element.mass(i, j));
      }
    }
  }
}

StiffnessAndMass assembled(const Triangulation& triangulation, const Lattice& lattice,
                           const ShellElements& elements, const Supported& supported) {
  Entries stiffness;
  Entries mass;
  for (Eigen::Index triangle = 0; triangle < lattice.triangles.rows(); ++triangle) {
    std::vector<Left> unknowns;
    for (const int place : lattice.triangles.row(triangle)) {
      for (int unknown = 0; unknown < shell_unknowns; ++unknown) {
        unknowns.push_back(supported.of(place, unknown));
      }
    }
    add_element(
        elements.of(triangulation.corners_m(triangulation.triangles.row(triangle), Eigen::all)),
        unknowns, stiffness, mass);
  }
  return {from_entries(stiffness, supported.count(), supported.count()),
          from_entries(mass, supported.count(), supported.count()), supported.first_of_place()};
}

// Of nodes that are all free, then of what is left.
void add_springs_to(const std::vector<SpringSupport>& springs, DiscreteBody& body) {
  if (springs.empty()) {
    return;
  }
  const auto rows = static_cast<Eigen::Index>(body.dofs.position.size());
  SparseMatrix of_nodes(rows, rows);
  add_springs(body.mesh, springs, free_dofs(std::vector<bool>(body.dofs.position.size(), false)),
              of_nodes);
  const SparseMatrix whole = of_nodes.selfadjointView<Eigen::Lower>();
  const SparseMatrix left = body.displacement.transpose() * whole * body.displacement;
  body.matrices.K += SparseMatrix{left.triangularView<Eigen::Lower>()};
}
}  // namespace

bool is_sheet(const Shape& shape) {
  const auto* const box = std::get_if<Box>(&shape);
  return box != nullptr &&
         std::min(box->size_m.x(), box->size_m.y()) >= least_width_to_thickness * box->size_m.z();
}

DiscreteBody shell_body(const Plate& plate, const Material& material, int order,
                        const std::vector<Fixation>& regions, const ProgressHook& progress) {
  check_material(material);
  if (!is_sheet(plate.shape)) {
    throw ModelError{fmt::format(
        "mesh.shell_width_m: shell elements are for plates of size_m that are at least {} times "
        "wider than thick",
        least_width_to_thickness)};
  }
  const Box& box = std::get<Box>(plate.shape);
  DiscreteBody body;
  Stopwatch watch;
  tell(progress, "meshing");
  const Triangulation triangulation = triangulated(box, plate.mesh.shell_width_m.value(), regions);
  const Lattice lattice = lattice_on(triangulation, order);
  body.mesh = layered(lattice, box.low_m().z(), box.high_m().z());
  body.order = order;
  body.elements = static_cast<int>(lattice.triangles.rows());
  body.cost.mesh_s = watch.lap_s();
  tell(progress, fmt::format("assembling {} shell elements", body.elements));
  const std::vector<bool> held = constrained_dofs(body.mesh, plate.shape, plate.fixations);
  body.dofs = free_dofs(held);
  const Supported supported{held, lattice.places_m.rows()};
  body.matrices =
      assembled(triangulation, lattice, ShellElements{material, box.size_m.z(), order}, supported);
  body.displacement = displacements(supported, lattice.places_m.rows());
  const auto springs = spring_supports(body.mesh, plate.shape, plate.fixations);
  add_springs_to(springs, body);
  body.matrices.resisted_motions = RigidMotions{body.mesh}.resisted(body.dofs, springs);
  body.matrices.rigid_body_modes = unresisted(body.matrices.resisted_motions);
  body.cost.assemble_s = watch.lap_s();
  return body;
}
}  // namespace tapstudy::core
