#include "core/model/elements/material.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
void require(bool holds, const char* property, double value, const char* allowed) {
  if (!holds) {
    throw InvalidInput{fmt::format("{}: {} is not allowed ({})", property, value, allowed)};
  }
}
}  // namespace

void check_material(const Material& material) {
  const double youngs = material.youngs_modulus_pa;
  const double density = material.density_kg_per_m3;
  const double poisson = material.poissons_ratio;
  require(std::isfinite(youngs) && youngs > 0.0, "youngs_modulus_pa", youngs, "greater than 0");
  require(std::isfinite(density) && density > 0.0, "density_kg_per_m3", density, "greater than 0");
  require(poisson > -1.0 && poisson < 0.5, "poissons_ratio", poisson,
          "greater than -1 and less than 0.5");
}
}  // namespace tapstudy::core
