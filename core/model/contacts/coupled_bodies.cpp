#include "core/model/contacts/coupled_bodies.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/model/elements/rigid_motions.hpp"
#include "core/model/elements/surface_region.hpp"
namespace tapstudy::core {
namespace {
using Entries = std::vector<Eigen::Triplet<double>>;

void add_block(const SparseMatrix& block, int first, Entries& entries) {
  for (Eigen::Index column = 0; column < block.outerSize(); ++column) {
    for (SparseMatrix::InnerIterator entry{block, column}; entry; ++entry) {
      entries.emplace_back(first + static_cast<int>(entry.row()), first + static_cast<int>(column),
                           entry.value());
    }
  }
}

class Elongations {
 public:
  Elongations(const Plate& plate, const Contacts& contacts, const CoupledBodies& system)
      : plate_{plate}, contacts_{contacts}, system_{system} {}

  std::vector<Elongation> all() const {
    std::vector<Elongation> elongations;
    for (std::size_t i = 0; i < contacts_.springs.size(); ++i) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (contacts_.springs[i].stiffness_n_per_m[axis] > 0.0) {
          elongations.push_back(along(axis, i));
        }
      }
    }
    return elongations;
  }

 private:
  Elongation along(Eigen::Index axis, std::size_t spring) const {
    const ContactSpring& joins = contacts_.springs[spring];
    const auto motions = 6 * static_cast<Eigen::Index>(system_.bodies.size());
    Elongation elongation{
        spring, joins.stiffness_n_per_m[axis], {}, Eigen::VectorXd::Zero(motions)};
    add({joins.from, spring, "from"}, axis, 1.0, elongation);
    add({joins.to, spring, "to"}, axis, -1.0, elongation);
    return elongation;
  }
  const Shape& shape_of(std::size_t body) const {
    return body == 0 ? plate_.shape : contacts_.bodies.at(body - 1).shape;
  }
  struct NamedEnd {
    const ContactSpring::End& end;
    std::size_t spring;
    const char* name;  // as in a protocol
  };
  void add(const NamedEnd& named, Eigen::Index axis, double sign, Elongation& elongation) const {
    const ContactSpring::End& end = named.end;
    const DiscreteBody& body = system_.bodies.at(end.body);
    const RigidMotions motions{body.mesh};
    const auto nodes = nodes_of(end.region, body.mesh, shape_of(end.body),
                                fmt::format("contact spring {}, {}", named.spring + 1, named.name));
    for (const NodeWeight& one : mean_weights(body.mesh, nodes)) {
      const int dof = body.dofs.position[static_cast<std::size_t>(3 * one.node + axis)];
      if (dof >= 0) {
        elongation.weights.emplace_back(system_.first_dof[end.body] + dof, sign * one.weight);
      }
      elongation.motions.segment<6>(6 * static_cast<Eigen::Index>(end.body)) +=
          sign * one.weight *
          motions.displacement(body.mesh.nodes_m.row(one.node).transpose(), axis);
    }
  }

  const Plate& plate_;
  const Contacts& contacts_;
  const CoupledBodies& system_;
};

// k g g', of which the lower triangle.
void add_spring(const Elongation& elongation, Entries& entries) {
  for (const auto& [row, a] : elongation.weights) {
    for (const auto& [column, b] : elongation.weights) {
      if (row >= column) {
        entries.emplace_back(row, column, elongation.stiffness_n_per_m * a * b);
      }
    }
  }
}

SparseMatrix from_entries(const Entries& entries, int size) {
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void place_after_one_another(CoupledBodies& system) {
  system.first_dof = {0};
  for (const DiscreteBody& body : system.bodies) {
    const int first = system.first_dof.back();
    const std::vector<int>& nodes = body.matrices.first_of_node;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      system.matrices.first_of_node.push_back(first + nodes[i]);
    }
    system.first_dof.push_back(first + body.dofs.count);
  }
  system.matrices.first_of_node.push_back(system.first_dof.back());
}
}  // namespace

CoupledBodies coupled(const Plate& plate, std::vector<DiscreteBody> bodies,
                      const Contacts& contacts) {
  CoupledBodies system;
  system.bodies = std::move(bodies);
  place_after_one_another(system);
  Entries stiffness;
  Entries mass;
  const auto motions = 6 * static_cast<Eigen::Index>(system.bodies.size());
  Eigen::MatrixXd& resisted = system.matrices.resisted_motions;
  resisted.setZero(motions, motions);
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const DiscreteBody& body = system.bodies[i];
    add_block(body.matrices.K, system.first_dof[i], stiffness);
    add_block(body.matrices.M, system.first_dof[i], mass);
    resisted.block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(i)) =
        body.matrices.resisted_motions;
  }
  system.elongations = Elongations{plate, contacts, system}.all();
  for (const Elongation& elongation : system.elongations) {
    add_spring(elongation, stiffness);
    resisted += elongation.motions * elongation.motions.transpose();
  }
  system.matrices.K = from_entries(stiffness, system.first_dof.back());
  system.matrices.M = from_entries(mass, system.first_dof.back());
  system.matrices.rigid_body_modes = unresisted(resisted);
  return system;
}
}  // namespace tapstudy::core
