#pragma once
#include <utility>
#include <vector>

#include "core/model/body_modes.hpp"
#include "core/model/discrete_body.hpp"
#include "core/model/joints/joints.hpp"
namespace tapstudy::core {
// One spring along one axis, by what it measures: the mean displacement of one region less that of
// the other.
struct Elongation {
  std::size_t spring{};  // its place in Joints
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

// Throws ModelError if a joint touches no node of its body, and if joints of two bodies cannot
// lie on one another at once.
CoupledBodies coupled(const Plate& plate, std::vector<DiscreteBody> bodies, const Joints& joints);

// What joins a body, the one of this number, to others.
std::vector<Fixation> regions_of(std::size_t body, const Joints& joints);

// The modes of a body together with those that it touches (body.joints), and its own part of
// their shapes. All bodies are one eigenproblem, not each one's modes coupled (component mode
// synthesis, Craig & Bampton 1968): nothing is truncated, and the count of modes is proved as that
// of a body alone. Throws ModelError as solve_body.
SolvedBody solve_joined_bodies(const BodySpec& body, const ProgressHook& progress,
                               ErrorEstimation estimation);
}  // namespace tapstudy::core
