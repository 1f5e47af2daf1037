#pragma once
#include "analysis/figures/colour_map.hpp"
#include "core/model/shape/box.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::analysis {
// How the upper face of a plate moves, seen from above, in colour.

// Its modes along the normal, each scaled to a largest displacement of 1 along any axis.
ColourMap map_of_modes(const core::VibratingPlate& plate, const core::Box& box,
                       const std::string& title);

// After a strike: a panel every dt (the paper's Figure 3), displacement along the normal [um].
struct PlateImpact {
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};
  double speed_m_s{0.3};
};
ColourMap map_of_strike(const core::VibratingPlate& plate, const core::Box& box,
                        const core::RenderSettings& settings, const PlateImpact& strike,
                        const std::string& title);
}  // namespace tapstudy::analysis
