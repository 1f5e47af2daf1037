#include "runner/reproduction/colour_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/figures/animated_png.hpp"
#include "analysis/figures/svg_formats.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::size_t shades = 16;
constexpr std::size_t stride = 2;

double largest_value(const analysis::ColourMap& map) {
  double most = 0.0;
  for (const analysis::ColourPanel& panel : map.panels) {
    for (const double value : panel.values) {
      most = std::max(most, std::abs(value));
    }
  }
  return most;
}

// From blue by way of violet to red.
std::string colour(std::size_t shade) {
  constexpr std::array blue{33.0, 102.0, 200.0};
  constexpr std::array red{205.0, 24.0, 43.0};
  const double share = static_cast<double>(shade) / static_cast<double>(shades - 1);
  const auto mixed = [&](std::size_t i) {
    return std::lround((1.0 - share) * blue.at(i) + share * red.at(i));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mixed(0), mixed(1), mixed(2));
}

// Squares of a shade as one path, the lowest row at the bottom.
std::string squares(const analysis::ColourMap& map, const analysis::ColourPanel& panel,
                    double most) {
  std::array<std::string, shades> paths;
  const std::size_t rows = (map.rows + stride - 1) / stride;
  for (std::size_t row = 0; row < map.rows; row += stride) {
    for (std::size_t column = 0; column < map.columns; column += stride) {
      const double share =
          most > 0.0 ? std::abs(panel.values.at(row * map.columns + column)) / most : 0.0;
      const auto shade =
          std::min(shades - 1, static_cast<std::size_t>(share * static_cast<double>(shades)));
      paths.at(shade) += fmt::format("M{} {}h1v1h-1z", column / stride, rows - 1 - row / stride);
    }
  }
  std::string svg;
  for (std::size_t shade = 0; shade < shades; ++shade) {
    if (!paths.at(shade).empty()) {
      svg += fmt::format("<path fill=\"{}\" d=\"{}\"/>", colour(shade), paths.at(shade));
    }
  }
  return svg;
}

// Of squares, across and up.
std::pair<std::size_t, std::size_t> size_of(const analysis::ColourMap& map) {
  return {(map.columns + stride - 1) / stride, (map.rows + stride - 1) / stride};
}
}  // namespace

std::vector<std::string> colour_svgs(const analysis::ColourMap& map) {
  const double most = largest_value(map);
  const auto [width, height] = size_of(map);
  std::vector<std::string> figures;
  for (const analysis::ColourPanel& panel : map.panels) {
    std::string svg = fmt::format(
        "<figure><svg class=map viewBox=\"0 0 {} {}\" role=img shape-rendering=crispEdges "
        "aria-label=\"{}\">",
        width, height, analysis::escaped(map.title + ", " + panel.title));
    figures.push_back(svg + squares(map, panel, most) +
                      fmt::format("</svg><figcaption>{}</figcaption></figure>\n",
                                  analysis::escaped(panel.title)));
  }
  return figures;
}

std::string colour_animation(const analysis::ColourMap& map) {
  constexpr int pixels = 360;
  constexpr unsigned frame_ms = 200;
  const double most = largest_value(map);
  const auto [width, height] = size_of(map);
  std::vector<std::string> frames;
  for (const analysis::ColourPanel& panel : map.panels) {
    frames.push_back(analysis::png_of_svg(
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                    "viewBox=\"0 0 {0} {1}\" shape-rendering=\"crispEdges\">{2}</svg>",
                    width, height, squares(map, panel, most)),
        pixels));
  }
  return analysis::animated_png(frames, frame_ms);
}
}  // namespace tapstudy::runner
