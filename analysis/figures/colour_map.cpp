#include "analysis/figures/colour_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/figures/gnuplot.hpp"
namespace tapstudy::analysis {
namespace {
constexpr std::size_t map_width = 260;
constexpr std::size_t map_height = 230;

double largest(const ColourMap& map) {
  double most = 0.0;
  for (const ColourPanel& panel : map.panels) {
    for (const double value : panel.values) {
      most = std::isfinite(value) ? std::max(most, std::abs(value)) : most;
    }
  }
  return most > 0.0 ? most : 1.0;
}

// Maps gnuplot's matrix indices, 0 to columns - 1 and rows - 1, to coordinates of the rectangle.
std::string placed(const ColourMap& map) {
  const double step_x = (map.high_x - map.low_x) / static_cast<double>(map.columns - 1);
  const double step_y = (map.high_y - map.low_y) / static_cast<double>(map.rows - 1);
  return fmt::format("using ({:.9g}+$1*{:.9g}):({:.9g}+$2*{:.9g}):3", map.low_x, step_x, map.low_y,
                     step_y);
}

std::string panel_script(const ColourMap& map, std::size_t index) {
  const ColourPanel& panel = map.panels[index];
  std::string script = fmt::format("$panel_{} << END\n", index);
  for (std::size_t i = 0; i < panel.values.size(); ++i) {
    script += std::isfinite(panel.values[i]) ? fmt::format("{:.6g}", panel.values[i]) : "NaN";
    script += (i + 1) % map.columns == 0 ? '\n' : ' ';
  }
  return script + fmt::format(
                      "END\nset title {} noenhanced\nplot $panel_{} matrix {} with image "
                      "pixels notitle\n",
                      quoted(panel.title), index, placed(map));
}

std::string script_of(const ColourMap& map, const std::string& file) {
  const std::size_t down = (map.panels.size() + map.across - 1) / map.across;
  const double most = largest(map);
  std::string script = fmt::format(
      "set terminal svg size {},{} font 'sans,11' background 'white'\nset output {}\n"
      "set size ratio -1\nset xlabel {}\nset ylabel {}\nset cblabel {}\n"
      "set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\nset cbrange [{:.6g}:{:.6g}]\n"
      "set palette defined (-1 '#2166ac', 0 '#f7f7f7', 1 '#b2182b')\nset format cb '%.3g'\n"
      "set xtics {:.3g}\nset ytics {:.3g}\nset multiplot layout {},{} title {} noenhanced\n",
      map_width * map.across, map_height * down + 40, quoted(file), quoted(map.x_label),
      quoted(map.y_label), quoted(map.value_label), map.low_x, map.high_x, map.low_y, map.high_y,
      -most, most, 0.5 * (map.high_x - map.low_x), 0.5 * (map.high_y - map.low_y), down, map.across,
      quoted(map.title));
  for (std::size_t i = 0; i < map.panels.size(); ++i) {
    script += panel_script(map, i);
  }
  return script + "unset multiplot\n";
}
}  // namespace

void draw_svg(const ColourMap& map, const std::string& file) {
  draw_with_gnuplot(script_of(map, file), file);
}
}  // namespace tapstudy::analysis
