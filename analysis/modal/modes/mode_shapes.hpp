#pragma once
#include <Eigen/Core>
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// The modal assurance criterion of two shapes at the same places (Allemang & Brown 1982): |a* b|^2
// / (a* a b* b), 1 for shapes in proportion, 0 for orthogonal ones or none.
double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b);

// One tap as one sensor saw it, which stays where it is while the place tapped changes.
struct PlacedTap {
  std::size_t place{};      // index
  std::size_t sensor{};     // index
  int impact{};             // the same for all sensors
  double impulse{};         // above 0, in any unit, the same for all
  double since_impact_s{};  // to the first sample of the decay, as far as it is known
  FreeDecay decay;
};

// The complex amplitudes c of modes with these poles in a decay, Re(c z^n), by least squares; c
// refers to the first sample.
Eigen::VectorXcd amplitudes_of(const FreeDecay& decay, const std::vector<Pole>& poles);

// Shapes of the modes at `places` places, a column for each mode, each up to a factor: what a tap
// excites of a mode is in proportion to its impulse and to the mode's displacement at the place
// (reciprocity). Amplitudes are taken back to the impact. All modes begin there with one phase or
// its opposite, which is the shape's sign; when the impact was, to better than a sample, is found
// from all of them together, within some milliseconds of what is given: the phases doubled agree
// best (weighted by amplitudes, against the strongest tap). Several taps at one place are averaged;
// of several sensors the one that sees most of a mode tells its shape.
Eigen::MatrixXd tapped_shapes(const std::vector<Pole>& poles, const std::vector<PlacedTap>& taps,
                              std::size_t places);
}  // namespace tapstudy::analysis
