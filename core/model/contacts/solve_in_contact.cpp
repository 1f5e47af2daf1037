#include "core/model/contacts/solve_in_contact.hpp"

#include <numbers>
#include <utility>

#include "core/model/contacts/contacts.hpp"
#include "core/model/contacts/coupled_bodies.hpp"
#include "core/model/modes/modal_solver.hpp"
namespace tapstudy::core {
namespace {
std::vector<Fixation> regions_of(std::size_t body, const Contacts& contacts) {
  std::vector<Fixation> regions;
  for (const ContactSpring& spring : contacts.springs) {
    for (const ContactSpring::End* const end : {&spring.from, &spring.to}) {
      if (end->body == body) {
        regions.push_back(end->region);
      }
    }
  }
  return regions;
}

std::vector<DiscreteBody> all_discretised(const BodySpec& body, const ProgressHook& progress) {
  const Contacts& contacts = *body.contacts;
  const Material unit{1.0, 1.0, body.poissons_ratio, {}};
  std::vector<DiscreteBody> all{
      discretised(body, unit, body.mesh.size, regions_of(0, contacts), progress)};
  for (const BodyInContact& other : contacts.bodies) {
    all.push_back(discretised(other, other.material, other.mesh.size,
                              regions_of(all.size(), contacts), progress));
  }
  return all;
}

// Of each mode.
Eigen::ArrayXd squares(const Elongation& elongation, const Eigen::MatrixXd& shapes) {
  Eigen::ArrayXd displacement = Eigen::ArrayXd::Zero(shapes.cols());
  for (const auto& [dof, weight] : elongation.weights) {
    displacement += weight * shapes.row(dof).transpose().array();
  }
  return displacement.square();
}

void set_energy_shares(const CoupledBodies& system, std::size_t springs, const Modes& modes,
                       BodyModes& found) {
  const auto bodies = static_cast<Eigen::Index>(system.bodies.size());
  const Eigen::ArrayXd eigenvalues = modes.omega_rad_s.square();
  found.kinetic_share.resize(bodies, modes.shapes.cols());
  found.strain_share.setZero(bodies + static_cast<Eigen::Index>(springs), modes.shapes.cols());
  for (Eigen::Index i = 0; i < bodies; ++i) {
    const auto body = static_cast<std::size_t>(i);
    const StiffnessAndMass& matrices = system.bodies[body].matrices;
    const Eigen::MatrixXd shapes =
        modes.shapes.middleRows(system.first_dof[body], system.bodies[body].dofs.count);
    found.kinetic_share.row(i) = shapes.cwiseProduct(matrices.mass() * shapes).colwise().sum();
    found.strain_share.row(i) =
        shapes.cwiseProduct(matrices.stiffness() * shapes).colwise().sum().array() /
        eigenvalues.transpose();
  }
  found.strain_share = found.strain_share.cwiseMax(0.0);  // rounding, where a body hardly bends
  for (const Elongation& elongation : system.elongations) {
    const Eigen::Index row = bodies + static_cast<Eigen::Index>(elongation.spring);
    found.strain_share.row(row).array() +=
        (elongation.stiffness_n_per_m * squares(elongation, modes.shapes) / eigenvalues)
            .transpose();
  }
}
}  // namespace

SolvedBody solve_in_contact(const BodySpec& body, const ProgressHook& progress) {
  CoupledBodies system = coupled(body, all_discretised(body, progress), *body.contacts);
  const double turn = 2.0 * std::numbers::pi;
  const Modes modes = solve_modes(system.matrices, body.band_limit_rad_per_m / turn, progress);
  SolvedBody solved;
  solved.modes.kappa_rad_per_m = modes.omega_rad_s;
  solved.modes.band_limit_rad_per_m = body.band_limit_rad_per_m;
  set_energy_shares(system, body.contacts->springs.size(), modes, solved.modes);
  solved.modes.report = report_on(system.bodies, modes);
  DiscreteBody& tapped = system.bodies.front();
  solved.displacement = with_constrained_rows(modes.shapes.topRows(tapped.dofs.count), tapped.dofs);
  solved.mesh = std::move(tapped.mesh);
  return solved;
}
}  // namespace tapstudy::core
