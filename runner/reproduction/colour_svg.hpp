#pragma once
#include <string>
#include <vector>

#include "analysis/figures/colour_map.hpp"
namespace tapstudy::runner {
// Each panel of a map as a figure within a page, every second value of every second row: magnitudes
// from blue, 0, to red, the largest of all panels (the paper's Figure 3).
std::vector<std::string> colour_svgs(const analysis::ColourMap& map);
// The same panels one after the other as an animated PNG.
std::string colour_animation(const analysis::ColourMap& map);
}  // namespace tapstudy::runner
