#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/model/elements/orthotropy.hpp"
namespace tapstudy::core {
// C = alpha M + beta K (paper eq. 3).
struct RayleighDamping {
  double alpha_per_s{0.0};
  double beta_s{0.0};
};
// Rayleigh damping through the damping ratios of the lowest and the highest mode inside the band
// (paper eq. 13).
struct TwoRatioDamping {
  double first_ratio{0.0};
  double last_ratio{0.0};
};
// Rayleigh damping fitted by least squares to damping ratios measured at some frequencies.
struct FittedDamping {
  struct Point {
    double frequency_hz{};
    double ratio{};
  };
  std::vector<Point> points;  // at least two different frequencies
};
// One damping ratio per mode inside the band, lowest first. Bodies of one material differ in their
// number of modes: those beyond the list have a ratio of their own, or the list must reach.
struct ModalDamping {
  std::vector<double> ratios;
  std::optional<double> further_ratio{};
};
// The same ratio for every mode.
struct ConstantDamping {
  double ratio{0.0};
};
using Damping =
    std::variant<RayleighDamping, TwoRatioDamping, FittedDamping, ModalDamping, ConstantDamping>;

// The damping of which every mode has `factor` times the ratio: coefficients and ratios are
// multiplied by it, because eq. 12 and 13 are linear in them. factor >= 0.
Damping scaled(Damping damping, double factor);

// Homogeneous, linearly elastic.
struct Material {
  double youngs_modulus_pa{};  // > 0; of an orthotropic material E_1, that of its first axis
  double density_kg_per_m3{};  // > 0
  double poissons_ratio{};     // in (-1, 0.5); of an orthotropic material unused, 0
  Damping damping{};
  std::optional<Orthotropy> orthotropy{};  // unset: isotropic
};

// Along the axes of an orthotropic material, in order; of an isotropic one the only modulus.
std::vector<double> youngs_moduli_pa(const Material& material);

// Equal text for equal materials.
std::string content_key(const Material& material);

// Throws InvalidInput naming the first property outside its range.
void check_material(const Material& material);
}  // namespace tapstudy::core
