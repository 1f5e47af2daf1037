#pragma once
#include <string>
#include <vector>

#include "core/model/shape/shape.hpp"
#include "core/settings/render_settings.hpp"
#include "core/tick/vibrating_plate.hpp"
namespace tapstudy::analysis {
struct ColourPanel {
  std::string title;
  std::vector<double> values;  // row by row, from the lowest y; NaN: left blank
};
// Values over a rectangle in colour, blue below and red above zero, panels in rows of `across`, all
// on one scale.
struct ColourMap {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string value_label;
  double low_x{};
  double high_x{};
  double low_y{};
  double high_y{};
  std::size_t columns{};  // values per row of a panel
  std::size_t rows{};
  std::size_t across{4};
  std::vector<ColourPanel> panels;
};

// Draws the map with gnuplot as SVG. Throws InvalidInput if the file already exists or cannot be
// written, or if gnuplot is not available.
void draw_svg(const ColourMap& map, const std::string& file);

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
