#pragma once
#include <string>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/fixation.hpp"
#include "core/model/plate.hpp"
namespace tapstudy::core {
// A body that touches others: what a plate stands on, or what stands on a plate. Its axes are
// parallel to those of the plate that is tapped; where it lies has no effect.
struct JoinedBody : Plate {
  Material material;
};

// Three springs along x, y and z between two bodies: each pulls on the mean displacement of a
// region of either, as a soft pad does that is glued to both.
struct JointSpring {
  struct End {
    std::size_t body{};  // 0: the plate that is tapped; n: the n-th of the other bodies
    Fixation region;     // of that body, what it holds and how unused
  };
  End from;
  End to;
  Vec3 stiffness_n_per_m{Vec3::Zero()};  // >= 0
  double loss_factor{0.0};               // of the pad: energy lost a cycle over 2 pi that stored
};

// The bodies joined to a tapped plate, and the springs between them. Linear: joints are never lost.
struct Joints {
  std::vector<JoinedBody> bodies;
  std::vector<JointSpring> springs;
};

// The same, with stiffness and density as multiples of these.
Joints relative_to(const Joints& joints, double youngs_modulus_pa, double density_kg_per_m3);

// Equal text for equal joints, damping aside.
std::string content_key(const Joints& joints);
}  // namespace tapstudy::core
