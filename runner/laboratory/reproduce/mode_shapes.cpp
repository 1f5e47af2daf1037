// Figure 3: the transition of the vibration's displacements, blue where small and red where large.
#include "runner/laboratory/reproduce/mode_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/figures/colour_map.hpp"
#include "analysis/report/figures/image_formats.hpp"
#include "core/files/data_url.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
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

// The scale runs from blue by way of violet to red.
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
        core::data_url("image/png", analysis::png_of_svg(svg, static_cast<int>(map.columns))));
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

namespace {
constexpr double still = 5.0;  // %

struct Shown {
  std::string method;
  std::string file;
  std::string stimulus;
};

double magnitude(const analysis::ColourPanel& panel, std::size_t place) {
  return std::abs(panel.values.at(place));
}

// The value nearest to a place on the face.
std::size_t place_of(const analysis::ColourMap& map, const core::Vec3& at_m) {
  const auto index = [](double at, double low, double high, std::size_t count) {
    return static_cast<std::size_t>(
        std::lround((at - low) / (high - low) * static_cast<double>(count - 1)));
  };
  return index(at_m.y(), map.low_y, map.high_y, map.rows) * map.columns +
         index(at_m.x(), map.low_x, map.high_x, map.columns);
}

// [um]
double largest_at(const analysis::ColourMap& map, const std::vector<std::size_t>& places) {
  double most = 0.0;
  for (const analysis::ColourPanel& panel : map.panels) {
    for (const std::size_t place : places) {
      most = std::max(most, magnitude(panel, place));
    }
  }
  return most;
}

double largest_anywhere(const analysis::ColourMap& map) {
  std::vector<std::size_t> all(map.rows * map.columns);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = i;
  }
  return largest_at(map, all);
}

// The map of a strike on the middle.
analysis::ColourMap struck(Bench& bench, const protocols::Protocol& protocol,
                           const protocols::PresentedStimulus& stimulus) {
  const auto plate = bench.models.plate_of(protocol, stimulus);
  return analysis::map_of_strike(*plate, std::get<core::Box>(stimulus.plate->shape),
                                 stimulus.rendering, {{0.0, 0.0}, tap_speed_m_s}, stimulus.name);
}

void keep_first(analysis::ColourMap& map) {
  constexpr std::size_t panels = 6;
  map.panels.resize(std::min(panels, map.panels.size()));
}

void add(Bench& bench, const Shown& shown_plate, Claim& claim) {
  const protocols::Protocol protocol = shipped_protocol(shown_plate.file);
  const auto stimulus = stimulus_with(protocol, protocol.stimulus(shown_plate.stimulus));
  analysis::ColourMap map = struck(bench, protocol, stimulus);
  std::vector<std::size_t> held;
  for (const core::Fixation& fixation : stimulus.plate->fixations) {
    held.push_back(place_of(map, fixation.at_m));
  }
  const double most_um = largest_anywhere(map);
  const double middle_um = largest_at(map, {place_of(map, core::Vec3::Zero())});
  claim.methods.push_back(
      {shown_plate.method,
       tap_command(shown_plate.file, shown_plate.stimulus, "P2", "--frames strike.svg"),
       {shown("largest displacement", most_um, "µm"),
        at_most(still, "largest at the held corners", 100.0 * largest_at(map, held) / most_um,
                "% of the largest"),
        at_least(50.0, "largest where it was struck", 100.0 * middle_um / most_um,
                 "% of the largest")}});
  if (claim.animations.empty()) {
    claim.animations.push_back({fmt::format("{}: {} in the {} ticks after a strike, one after the "
                                            "other, blue where nothing moves, red at {} µm",
                                            shown_plate.method, shown_plate.stimulus,
                                            map.panels.size(), analysis::rounded(most_um)),
                                std::string{strike_animation_file}, colour_animation(map)});
  }
  keep_first(map);
  claim.drawings.push_back(
      {fmt::format("{}: {} after a strike, red is {} µm", shown_plate.method, shown_plate.stimulus,
                   analysis::rounded(largest_anywhere(map))),
       colour_figures(map)});
  analysis::ColourMap modes = analysis::map_of_modes(*bench.models.plate_of(protocol, stimulus),
                                                     std::get<core::Box>(stimulus.plate->shape),
                                                     "mode of " + stimulus.name);
  keep_first(modes);
  claim.drawings.push_back(
      {fmt::format("{}: the first mode shapes of {}", shown_plate.method, shown_plate.stimulus),
       colour_figures(modes), false});
}
}  // namespace

std::vector<Claim> mode_shapes(Bench& bench) {
  Claim claim{.name = "vibration_seen_from_above",
              .section = "section 5, Figure 3",
              .statement =
                  "After an impact the displacement spreads over the plate, large where it was "
                  "struck and small at the four corners that are held.",
              .rule =
                  "In the twelve ticks after a strike on the middle, the largest displacement of "
                  "a held corner's upper face is at most 5 % of the largest anywhere, and that of "
                  "the middle at least half of it."};
  add(bench, {std::string{method::printed}, "protocols/paper/plate_model.yaml", "aluminium"},
      claim);
  for (const Route& route : bench.plates) {
    if (!route.is_printed && !route.differs_in_aluminium_only) {
      add(bench, {route.name, route.file, route.aluminium + "_four"}, claim);
    }
  }
  return {claim};
}
}  // namespace tapstudy::runner
