#pragma once
#include "analysis/figures/colour_map.hpp"
#include "core/model/shape/box.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::analysis {
// Colour maps of the displacement of a plate's upper face, seen from above.

// Normal component of its mode shapes, each scaled to a maximum displacement of 1 along any axis.
ColourMap map_of_modes(const core::VibratingPlate& plate, const core::Box& box,
                       const std::string& title);

// After an impact: one panel every dt (the paper's Figure 3), normal displacement [um].
struct PlateImpact {
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};
  double speed_m_s{0.3};
};
ColourMap map_of_strike(const core::VibratingPlate& plate, const core::Box& box,
                        const core::RenderSettings& settings, const PlateImpact& strike,
                        const std::string& title);
}  // namespace tapstudy::analysis
