#pragma once
#include <Eigen/Core>

#include "core/model/shape/shape.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::runner {
// A finger that comes straight down on a place and stays there.
struct Strike {
  core::Vec3 at_m{core::Vec3::Zero()};  // on the body's surface, plate frame
  double speed_m_s{0.3};
};

// The part of the force that is vibration [N], one value a tick from the strike on. The hand is
// held still, so that what is compared is the plate and not the hand's answer to it.
// Throws ModelError if the finger meets nothing.
Eigen::ArrayXd felt_force_n(const core::VibratingPlate& plate, const core::Shape& shape,
                            const core::RenderSettings& settings, const Strike& strike,
                            Eigen::Index ticks);

// Median time of one tick [ns] in contact, the finger sliding in a small circle round the place.
double tick_ns(const core::VibratingPlate& plate, const core::Shape& shape,
               const core::RenderSettings& settings, const Strike& strike);
}  // namespace tapstudy::runner
