#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/fixation.hpp"
#include "core/model/mesh/tetgen_mesher.hpp"
namespace tapstudy::core {
struct Meshing {
  MeshSize size;
  int order{1};  // of the elements: 1 (T4), 2 (T10), or chosen_order (element_order.hpp)
  // Of a plate: shell elements this wide (shells/shell_body.hpp) in place of tetrahedra, for which
  // the settings above are. Unset: tetrahedra.
  std::optional<double> shell_width_m{};
  // Refine until no frequency in the band changes by more than this fraction; unset: no refinement.
  std::optional<double> accuracy{};
  // Order, size and flattening, or shells, are chosen for the accuracy (refinement/refinement.hpp);
  // what is stated here of them is not used.
  bool is_automatic{false};
};

// The theory by which a body's modes are found: elasticity, by finite elements; or that of
// Euler-Bernoulli beams, in closed form (core/model/beam.hpp).
enum class Theory { solid, beam };

// A plate, or any other body, without its material: shape, mesh settings and boundary conditions.
struct Plate {
  Shape shape;
  Meshing mesh;
  std::vector<Fixation> fixations;
  Theory theory{Theory::solid};
};

// Equal text for equal plates.
std::string content_key(const Plate& plate);

struct Joints;  // core/model/joints/joints.hpp

// A plate of a given material, with the frequency band that its model must cover.
struct PlateSpec : Plate {
  Material material;
  double band_limit_hz{};                  // > 0; modes above are left out
  std::shared_ptr<const Joints> joints{};  // nullptr: it touches no other body
};

// A body of any shape, independent of Young's modulus E and density rho. Stiffness, mass and
// spectrum scale exactly with them, so one solution for E = 1 Pa, rho = 1 kg/m³ serves every
// material with the same Poisson's ratio or orthotropy: omega = kappa sqrt(E / rho), with kappa in
// rad/m, and mode shapes are divided by sqrt(rho). A body on springs serves one Young's modulus
// only: its springs are in N/m per Pa of it. A body in contact with others serves one density only,
// too.
struct BodySpec : Plate {
  double poissons_ratio{};
  double band_limit_rad_per_m{};           // of kappa; > 0
  std::shared_ptr<const Joints> joints{};  // relative to this body's material
  std::optional<Orthotropy> orthotropy{};  // as Material's
  Material unit_material() const { return {1.0, 1.0, poissons_ratio, {}, orthotropy}; }
};
}  // namespace tapstudy::core
