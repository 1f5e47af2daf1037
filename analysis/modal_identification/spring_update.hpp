#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "analysis/modal_identification/model_matching.hpp"
namespace tapstudy::analysis {
// The model's frequencies at one Young's modulus, with springs so many times as stiff as they were
// stated [Hz], ascending.
using FrequenciesOnSprings = std::function<std::vector<double>(double factor)>;

struct SpringUpdate {
  ModelUpdate model;       // its modulus with the interval of both together
  Estimate spring_factor;  // on the stiffness of all springs as stated
  // At the modulus given, with springs over Young's modulus as found.
  std::vector<double> model_hz;
};

// Springs and Young's modulus E together, by least squares of logarithms of frequencies: f is
// sqrt(E) times a function of springs / E alone. For each springs / E within a factor of 100 of
// the stated one, E and the modes' assignment are update_youngs_modulus's; the least of these sums
// is taken. Intervals are Student's t of the linearised problem, with two degrees of freedom less
// than modes. Unset where fewer than three modes find a partner, or the sum only falls towards
// springs that are far softer or stiffer: then the modes do not tell.
std::optional<SpringUpdate> update_springs(const std::vector<Estimate>& measured_hz,
                                           const FrequenciesOnSprings& frequencies_hz,
                                           double youngs_modulus_pa);
}  // namespace tapstudy::analysis
