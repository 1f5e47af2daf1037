#pragma once
#include <Eigen/Core>

#include "core/model/shape/shape.hpp"
#include "core/settings/render_settings.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::runner {
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
