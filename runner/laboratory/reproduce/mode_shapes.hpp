#pragma once
#include <string>
#include <vector>

#include "analysis/report/figures/colour_map.hpp"
namespace tapstudy::runner {
// Each panel of a map as an SVG with a square for every value, the lowest row at the bottom:
// magnitudes from blue, 0, to red, the largest of all panels (the paper's Figure 3).
std::vector<std::string> colour_svgs(const analysis::ColourMap& map);
// The same as figures within a page, pictures of a pixel a value, which a browser draws smooth.
std::vector<std::string> colour_figures(const analysis::ColourMap& map);
// The same panels one after the other as an animated PNG.
std::string colour_animation(const analysis::ColourMap& map);
}  // namespace tapstudy::runner
