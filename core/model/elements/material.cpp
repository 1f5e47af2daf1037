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

std::string key_of(const RayleighDamping& damping) {
  return fmt::format("rayleigh {:a} {:a}", damping.alpha_per_s, damping.beta_s);
}
std::string key_of(const TwoRatioDamping& damping) {
  return fmt::format("two {:a} {:a}", damping.first_ratio, damping.last_ratio);
}
std::string key_of(const FittedDamping& damping) {
  std::string key{"fitted"};
  for (const FittedDamping::Point& point : damping.points) {
    key += fmt::format(" {:a} {:a}", point.frequency_hz, point.ratio);
  }
  return key;
}
std::string key_of(const ConstantDamping& damping) {
  return fmt::format("constant({:a})", damping.ratio);
}
std::string key_of(const ModalDamping& damping) {
  std::string key{"modal"};
  for (const double ratio : damping.ratios) {
    key += fmt::format(" {:a}", ratio);
  }
  if (damping.further_ratio) {
    key += fmt::format(" further {:a}", *damping.further_ratio);
  }
  return key;
}

void scale(RayleighDamping& damping, double factor) {
  damping.alpha_per_s *= factor;
  damping.beta_s *= factor;
}
void scale(TwoRatioDamping& damping, double factor) {
  damping.first_ratio *= factor;
  damping.last_ratio *= factor;
}
void scale(FittedDamping& damping, double factor) {
  for (FittedDamping::Point& point : damping.points) {
    point.ratio *= factor;
  }
}
void scale(ModalDamping& damping, double factor) {
  for (double& ratio : damping.ratios) {
    ratio *= factor;
  }
  if (damping.further_ratio) {
    *damping.further_ratio *= factor;
  }
}
void scale(ConstantDamping& damping, double factor) {
  damping.ratio *= factor;
}
}  // namespace

Damping scaled(Damping damping, double factor) {
  std::visit([&](auto& one) { scale(one, factor); }, damping);
  return damping;
}

std::vector<double> youngs_moduli_pa(const Material& material) {
  std::vector<double> moduli_pa;
  if (!material.orthotropy) {
    return {material.youngs_modulus_pa};
  }
  for (const double modulus : material.orthotropy->moduli) {
    moduli_pa.push_back(modulus * material.youngs_modulus_pa);
  }
  return moduli_pa;
}

std::string content_key(const Material& material) {
  return fmt::format(
      "material({:a},{:a},{:a},{}{})", material.youngs_modulus_pa, material.density_kg_per_m3,
      material.poissons_ratio,
      std::visit([](const auto& damping) { return key_of(damping); }, material.damping),
      content_key(material.orthotropy));
}

void check_material(const Material& material) {
  const double youngs = material.youngs_modulus_pa;
  const double density = material.density_kg_per_m3;
  const double poisson = material.poissons_ratio;
  require(std::isfinite(youngs) && youngs > 0.0, "youngs_modulus_pa", youngs, "greater than 0");
  require(std::isfinite(density) && density > 0.0, "density_kg_per_m3", density, "greater than 0");
  require(poisson > -1.0 && poisson < 0.5, "poissons_ratio", poisson,
          "greater than -1 and less than 0.5");
  if (material.orthotropy) {
    if (const auto fault = fault_of(*material.orthotropy)) {
      throw InvalidInput{fmt::format("{}: {}", fault->property, fault->words)};
    }
  }
}
}  // namespace tapstudy::core
