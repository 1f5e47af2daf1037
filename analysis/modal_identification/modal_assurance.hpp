#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "analysis/modal_identification/repeated_modes.hpp"
namespace tapstudy::analysis {
// The modal assurance criterion of two shapes at the same places (Allemang & Brown 1982): (a.b)^2 /
// (a.a b.b), 1 for shapes in proportion, 0 for orthogonal ones or none.
double modal_assurance(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

// One tap of a recording made by a sensor that stays where it is, while the place tapped changes.
struct PlacedTap {
  std::size_t place{};      // index
  std::string channel{};    // the sensor's
  double impulse{};         // in any unit, the same for all
  double since_impact_s{};  // from the impact to the first sample of its decay
};

// A mode's shape at `places` places, up to a factor: what a tap excites of a mode is in proportion
// to its impulse and to the mode's displacement at the place (reciprocity). Amplitudes are taken
// back to the impact; signs are those of their phases, against the largest; several taps at one
// place are averaged; 0 where no tap shows the mode; of several sensors the one that sees most of
// it. taps: those that modes_over_taps was given.
Eigen::VectorXd tapped_shape(const RepeatedMode& mode, const std::vector<PlacedTap>& taps,
                             std::size_t places);
}  // namespace tapstudy::analysis
