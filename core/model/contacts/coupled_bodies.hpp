#pragma once
#include <utility>
#include <vector>

#include "core/model/contacts/contacts.hpp"
#include "core/model/discrete_body.hpp"
namespace tapstudy::core {
// One spring along one axis, by what it measures: the mean displacement of one region less that of
// the other.
struct Elongation {
  std::size_t spring{};  // its place in Contacts
  double stiffness_n_per_m{};
  std::vector<std::pair<int, double>> weights;  // of free degrees of freedom
  Eigen::VectorXd motions;                      // of the bodies' rigid-body motions
};

// Bodies joined by springs as one system: the first is the plate that is tapped.
struct CoupledBodies {
  std::vector<DiscreteBody> bodies;
  std::vector<int> first_dof;  // of each body among all, and their number
  std::vector<Elongation> elongations;
  StiffnessAndMass matrices;  // block-diagonal but for the springs
};

// Throws ModelError if a contact touches no node of its body, and if contacts of two bodies cannot
// lie on one another at once.
CoupledBodies coupled(const Plate& plate, std::vector<DiscreteBody> bodies,
                      const Contacts& contacts);
}  // namespace tapstudy::core
