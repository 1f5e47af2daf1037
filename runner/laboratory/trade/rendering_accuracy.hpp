#pragma once
#include <Eigen/Core>

#include "core/model/shape/shape.hpp"
#include "core/settings/render_settings.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/state_transition.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::runner {
// Force time series [N]: one row per tick, one column per tapping point.
using Forces = Eigen::ArrayXXd;

// The frequency of the integrated mode: Newmark's is 2 atan(omega dt / 2) / dt, undamped.
Eigen::ArrayXd numerical_frequency_hz(const Eigen::ArrayXd& frequency_hz,
                                      core::Integrator integrator, double rate_hz);

// Modes with their shapes sampled at the same points of a body: one column per mode.
struct SampledModes {
  Eigen::ArrayXd frequency_hz;  // ascending
  Eigen::MatrixXd shape;
};

// Each mode of the reference below the band limit is matched with the found mode whose shape is
// most like it by the modal assurance criterion (Allemang & Brown 1982). Where frequencies are
// close, any mixture of their shapes is a mode as well, so their criteria add up.
struct ModeMatch {
  double frequency_error{};  // the largest of a matched mode; a missing one counts as if it lay at
                             // the band limit
  int missing{};             // of the reference: less than half of the shape is found
  int extra{};               // found below the band limit, but unlike any of the reference
};
ModeMatch match_modes(const SampledModes& reference, const SampledModes& found,
                      double band_limit_hz);

// |found - reference| / |reference| in the L2 norm, maximum over the tapping points.
double force_error(const Forces& reference, const Forces& found);

// The difference in level [dB], of largest magnitude over the tapping points and the third octaves
// from 20 Hz to the band limit (IEC 61260-1, base two). Third octaves that hold less than a
// thousandth of the reference's energy at that point are not felt beside the others. 60 dB where
// nothing is left.
double level_error_db(const Forces& reference, const Forces& found, double rate_hz,
                      double band_limit_hz);

// The difference in decay below the band limit [dB], maximum over the tapping points: by how much
// the level after the first 40 ms, less the level before, differs from the reference's. Decays
// beyond 20 dB count as 20 dB.
double decay_error_db(const Forces& reference, const Forces& found, double rate_hz,
                      double band_limit_hz);

// Gain of the zero-order hold at a frequency: |sinc(f dt)|.
Eigen::ArrayXd held_gain(const Eigen::ArrayXd& frequency_hz, double rate_hz);

// The plate's vibration without the decaying sinusoid, whatever the stimulus's technique.
const core::Technique& plate_alone();

// A finger that descends vertically on a point and stays there.
struct Strike {
  core::Vec3 at_m{core::Vec3::Zero()};  // on the body's surface, plate frame
  double speed_m_s{0.3};
};

// The vibration component of the force [N], one value per tick from the impact on. The hand is held
// still, so that the comparison covers the plate and not the hand's response to it.
// Throws ModelError if the finger misses the body.
Eigen::ArrayXd felt_force_n(const core::VibratingPlate& plate, const core::Shape& shape,
                            const core::RenderSettings& settings, const Strike& strike,
                            Eigen::Index ticks);

// Median computing time of one tick [ns] in contact, with the finger sliding in a small circle.
double tick_ns(const core::VibratingPlate& plate, const core::Shape& shape,
               const core::RenderSettings& settings, const Strike& strike);
}  // namespace tapstudy::runner
