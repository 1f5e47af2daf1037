#include "runner/commands/impact_energy.hpp"

#include <fmt/format.h>

#include "core/techniques/force_part.hpp"
#include "runner/experiments/counted.hpp"
namespace tapstudy::runner {
namespace {
core::Contact contact_from_above(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m) {
  constexpr double far_m = 100.0;
  core::Contact contact;
  contact.god_object_m << at_m, 0.0;
  if (plate.triangles) {
    const core::Vec3 above{at_m.x(), at_m.y(), far_m};
    const core::Vec3 below{at_m.x(), at_m.y(), -far_m};
    const auto entry = plate.triangles->first_entered(above, below, 0.0);
    contact.triangle = entry.triangle;
    if (entry.triangle != core::TriangleTree::none) {
      contact.god_object_m = above + entry.along * (below - above);
      contact.normal = plate.triangles->normal(entry.triangle);
      contact.barycentric = plate.triangles->barycentric(entry.triangle, contact.god_object_m);
    }
  }
  return contact;
}

struct Strike {
  std::string point;
  double energy_share{};
};
Strike strongest(const core::VibratingPlate& plate, const protocols::PresentedStimulus& stimulus) {
  Strike most;
  for (const auto& [name, at_m] : stimulus.plate->tapping_points_m) {
    const double share = impact_energy_share(plate, at_m, stimulus.rendering.finger.mass_kg);
    most = share > most.energy_share ? Strike{name, share} : most;
  }
  return most;
}
}  // namespace

double impact_energy_share(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m,
                           double finger_kg) {
  const core::Contact contact = contact_from_above(plate, at_m);
  if (plate.triangles && contact.triangle == core::TriangleTree::none) {
    return 0.0;
  }
  const core::SurfacePoint place = plate.place_of(contact);
  Eigen::RowVectorXd along = Eigen::RowVectorXd::Zero(plate.model.shape.cols());
  for (std::size_t i = 0; i < place.count; ++i) {
    const auto rows = plate.model.shape.middleRows<3>(3 * Eigen::Index{place.nodes[i]});
    along += place.weights[i] * (contact.normal.transpose() * rows);
  }
  return finger_kg * along.squaredNorm();
}

void warn_of_light_plates(const protocols::Protocol& protocol, ModelLibrary& models) {
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (!stimulus.technique->needs_model()) {
      continue;
    }
    const protocols::PresentedStimulus own = stimulus_with(protocol, stimulus);
    const int rigid = models.body_of(protocol, own)->report.rigid_body_modes;
    if (rigid > 0) {
      fmt::print(
          "  warning: {} can move as a rigid body in {}, which are left out: there it is felt as "
          "held (fix it, or put it on springs)\n",
          stimulus.name, counted(static_cast<std::size_t>(rigid), "way"));
    }
    const Strike strike = strongest(*models.plate_of(protocol, own), own);
    if (stimulus.technique->has(core::plate_vibration) && strike.energy_share > 1.0) {
      fmt::print(
          "  warning: {} is too light for the finger: struck at {} it takes {:.3g} times the "
          "finger's energy (a smaller mass_kg; fem-coupled takes from the finger what it gives)\n",
          stimulus.name, strike.point, strike.energy_share);
    }
  }
}
}  // namespace tapstudy::runner
