#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "analysis/modal/decay/estimate.hpp"
namespace tapstudy::analysis {
struct MatchedMode {
  std::size_t measured{};             // index into the measured modes
  std::size_t model{};                // index into the model's modes
  double misfit{};                    // measured / model - 1 after the update
  std::optional<double> assurance{};  // of their shapes; unset where those are not known
};

struct ModelUpdate {
  std::vector<MatchedMode> matched;    // ascending
  std::vector<std::size_t> unmatched;  // measured modes without one
  Estimate youngs_modulus_pa;
  double rms_misfit{};  // of the logarithms of frequencies
  // Another Young's modulus, of an assignment that fits as many modes nearly as well: a reason to
  // look twice.
  std::optional<double> rival_pa;
};

// Measured modes differ from their model's by at most this share of the frequency, once the common
// factor is taken out.
inline constexpr double max_match_difference = 0.15;

// Young's modulus by least squares of logarithms of frequencies, which are proportional to its root
// at one Poisson's ratio, density and geometry. Modes are assigned so that the sum of squared
// differences of the logarithms is least, each at most once; a mode without a partner costs
// max_match_difference squared, a pair whose shapes are known (assurance: measured by model modes,
// modal_assurance; empty: not known) half as much times 1 less their assurance. Assignment and
// factor are repeated until they settle, from the modulus given; another assignment, of a modulus
// from a quarter to four times, is taken if it has as many modes, three or more, at less than a
// quarter of the cost. The interval is Student's t of the scatter between modes, or of one mode its
// own. Both ascending, not empty, above 0 [Hz]. Unset if no mode finds a partner.
std::optional<ModelUpdate> update_youngs_modulus(const std::vector<Estimate>& measured_hz,
                                                 const std::vector<double>& model_hz,
                                                 double youngs_modulus_pa,
                                                 const Eigen::MatrixXd& assurance = {});

// The sum of squares of that assignment, with the cost of modes without a partner. The model may
// have no modes.
double match_cost(const std::vector<Estimate>& measured_hz, const std::vector<double>& model_hz);

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
