#pragma once
#include <string>
#include <vector>
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
}  // namespace tapstudy::analysis
