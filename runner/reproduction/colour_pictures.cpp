#include "runner/reproduction/colour_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/blocks/html_parts.hpp"
#include "analysis/figures/animated_png.hpp"
#include "analysis/figures/svg_formats.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::size_t shades = 64;

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

// Squares of a shade as one path.
std::string squares(const analysis::ColourMap& map, const analysis::ColourPanel& panel,
                    double most) {
  std::array<std::string, shades> paths;
  for (std::size_t row = 0; row < map.rows; ++row) {
    for (std::size_t column = 0; column < map.columns; ++column) {
      const double share =
          most > 0.0 ? std::abs(panel.values.at(row * map.columns + column)) / most : 0.0;
      const auto shade =
          std::min(shades - 1, static_cast<std::size_t>(share * static_cast<double>(shades)));
      paths.at(shade) += fmt::format("M{} {}h1v1h-1z", column, map.rows - 1 - row);
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

// A pixel a value.
std::vector<std::string> pictures(const analysis::ColourMap& map) {
  std::vector<std::string> uris;
  for (const std::string& svg : colour_svgs(map)) {
    uris.push_back(
        analysis::png_data_uri(analysis::png_of_svg(svg, static_cast<int>(map.columns))));
  }
  return uris;
}
}  // namespace

std::vector<std::string> colour_svgs(const analysis::ColourMap& map) {
  const double most = largest_value(map);
  std::vector<std::string> all;
  for (const analysis::ColourPanel& panel : map.panels) {
    all.push_back(
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                    "viewBox=\"0 0 {0} {1}\" shape-rendering=\"crispEdges\">{2}</svg>",
                    map.columns, map.rows, squares(map, panel, most)));
  }
  return all;
}

std::vector<std::string> colour_figures(const analysis::ColourMap& map) {
  const std::vector<std::string> uris = pictures(map);
  std::vector<std::string> figures;
  for (std::size_t i = 0; i < uris.size(); ++i) {
    const std::string& title = map.panels[i].title;
    figures.push_back(
        fmt::format("<figure><img class=map width={} height={} src=\"{}\" alt=\"{}\">"
                    "<figcaption>{}</figcaption></figure>\n",
                    map.columns, map.rows, uris[i], analysis::escaped(map.title + ", " + title),
                    analysis::escaped(title)));
  }
  return figures;
}

std::string colour_animation(const analysis::ColourMap& map) {
  constexpr int pixels = 360;
  constexpr unsigned frame_ms = 200;
  std::vector<std::string> frames;
  for (const std::string& uri : pictures(map)) {
    frames.push_back(analysis::png_of_svg(
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\">"
                    "<image width=\"{0}\" height=\"{1}\" href=\"{2}\"/></svg>",
                    map.columns, map.rows, uri),
        pixels));
  }
  return analysis::animated_png(frames, frame_ms);
}
}  // namespace tapstudy::runner
