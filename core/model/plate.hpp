#pragma once
#include <optional>
#include <vector>

#include "core/model/elements/material.hpp"
#include "core/model/fixation.hpp"
#include "core/model/mesh/mesh_size.hpp"
namespace tapstudy::core {
struct Meshing {
  MeshSize size;
  int order{1};  // of the elements: 1 (T4) or 2 (T10)
  // Refine until no frequency in the band moves by more than this fraction; unset: the size given.
  std::optional<double> accuracy{};
};

// What a plate, or any other body, is before it has a material: its shape, how it is meshed, and
// its boundary conditions.
struct Plate {
  Shape shape;
  Meshing mesh;
  std::vector<Fixation> fixations;
};

// A plate of a material, with the band that its model must reach.
struct PlateSpec : Plate {
  Material material;
  double band_limit_hz{};  // > 0; modes above are left out
};

// A plate before its stiffness and density are known. Stiffness, mass and spectrum scale exactly
// with Young's modulus E and density rho, so one solution for E = 1 Pa, rho = 1 kg/m³ serves every
// material of one Poisson's ratio: omega = kappa sqrt(E / rho), with kappa in rad/m, and mode
// shapes divide by sqrt(rho).
struct BodySpec : Plate {
  double poissons_ratio{};
  double band_limit_rad_per_m{};  // of kappa; > 0
};
}  // namespace tapstudy::core
