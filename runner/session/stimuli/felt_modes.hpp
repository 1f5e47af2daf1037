#pragma once
#include <string>
#include <vector>

#include "core/tick/vibrating_plate.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// Each mode's displacement along the normal where the plate is met from above [kg^-1/2]; 0 where it
// is not. at_m: plate frame.
Eigen::RowVectorXd modes_at(const core::VibratingPlate& plate, const Eigen::Vector2d& at_m);

// By how much the vibration of each mode stays below that of the strongest mode, where the plate is
// tapped: an impact of momentum p on a plate at rest gives mode i the velocity phi_i p (paper
// eq. 15), there it then moves by phi_i^2 p / w_i at most (eq. 16, without damping), and is felt
// through spring k and damper c as |k + i w_i c| phi_i^2 p / w_i (eq. 17). The level in dB of that
// over the largest of all modes at the same place, at the place where it is largest; -infinity
// where no place moves. Places: the tapping points and, within within_m of each, two rings of
// eight.
Eigen::ArrayXd levels_of_modes_db(const core::VibratingPlate& plate,
                                  const protocols::PresentedStimulus& stimulus, double within_m);

struct UnfeltMode {
  double frequency_hz{};
  double level_db{};
};

// Those below the level, ascending; never the strongest.
std::vector<UnfeltMode> unfelt_modes(const core::VibratingPlate& plate,
                                     const protocols::PresentedStimulus& stimulus,
                                     const protocols::DroppedModes& which);

// The model without them, where the protocol drops any.
core::ModalModel rendered_model(const protocols::Protocol& protocol,
                                const protocols::PresentedStimulus& stimulus,
                                core::ModalModel model);

// "143 Hz (-92 dB), 211 Hz (below -200 dB)"
std::string describe(const std::vector<UnfeltMode>& modes);
}  // namespace tapstudy::runner
