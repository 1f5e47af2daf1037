#include "core/model/joints/joints.hpp"

#include <fmt/format.h>
namespace tapstudy::core {
namespace {
std::string content_key(const JointSpring::End& end) {
  return fmt::format("{} {}", end.body, core::content_key(end.region));
}
}  // namespace

Joints relative_to(const Joints& joints, double youngs_modulus_pa, double density_kg_per_m3) {
  Joints relative = joints;
  for (JoinedBody& body : relative.bodies) {
    body.material.youngs_modulus_pa /= youngs_modulus_pa;
    body.material.density_kg_per_m3 /= density_kg_per_m3;
    for (Fixation& fixation : body.fixations) {
      if (fixation.springs_n_per_m) {
        *fixation.springs_n_per_m /= youngs_modulus_pa;
      }
    }
  }
  for (JointSpring& spring : relative.springs) {
    spring.stiffness_n_per_m /= youngs_modulus_pa;
  }
  return relative;
}

std::string content_key(const Joints& joints) {
  std::string key = "contacts";
  for (const JoinedBody& body : joints.bodies) {
    key += fmt::format(" body({},{:a},{:a},{:a}{})", content_key(static_cast<const Plate&>(body)),
                       body.material.youngs_modulus_pa, body.material.density_kg_per_m3,
                       body.material.poissons_ratio, content_key(body.material.orthotropy));
  }
  for (const JointSpring& spring : joints.springs) {
    key += fmt::format(" spring({},{},{:a},{:a},{:a})", content_key(spring.from),
                       content_key(spring.to), spring.stiffness_n_per_m.x(),
                       spring.stiffness_n_per_m.y(), spring.stiffness_n_per_m.z());
  }
  return key;
}
}  // namespace tapstudy::core
