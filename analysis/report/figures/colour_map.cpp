#include "analysis/report/figures/colour_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/figures/figure.hpp"
#include "core/tick/modal_state.hpp"
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

namespace {
constexpr Eigen::Index points_a_side = 41;
constexpr Eigen::Index max_modes_drawn = 24;
constexpr int frames = 12;
const core::Vec3 outward{0.0, 0.0, 1.0};

ColourMap empty_map(const core::Box& box, const std::string& title) {
  ColourMap map;
  map.title = title;
  map.x_label = "x [m]";
  map.y_label = "y [m]";
  map.low_x = box.low_m().x();
  map.high_x = box.high_m().x();
  map.low_y = box.low_m().y();
  map.high_y = box.high_m().y();
  map.columns = points_a_side;
  map.rows = points_a_side;
  return map;
}

// Calls f(x, y) for every value of a panel, in its order.
template <class F>
std::vector<double> over_face(const core::Box& box, const F& f) {
  std::vector<double> values;
  const auto places = [](double low, double high) {
    return Eigen::ArrayXd::LinSpaced(points_a_side, low, high);
  };
  for (const double y : places(box.low_m().y(), box.high_m().y())) {
    for (const double x : places(box.low_m().x(), box.high_m().x())) {
      values.push_back(f(x, y));
    }
  }
  return values;
}
}  // namespace

ColourMap map_of_modes(const core::VibratingPlate& plate, const core::Box& box,
                       const std::string& title) {
  ColourMap map = empty_map(box, title);
  map.value_label = "displacement, largest 1";
  const core::ModalModel& model = plate.model;
  const Eigen::Index modes = std::min(model.frequency_hz.size(), max_modes_drawn);
  for (Eigen::Index mode = 0; mode < modes; ++mode) {
    // scaled by the maximum in any direction, so that in-plane modes stay pale
    const double largest = model.shape.col(mode).cwiseAbs().maxCoeff();
    const std::vector<double> values = over_face(box, [&](double x, double y) {
      const core::SurfacePoint point = plate.locator->locate(x, y);
      double sum = 0.0;
      for (std::size_t i = 0; i < point.count; ++i) {
        sum += point.weights[i] * model.shape(3 * Eigen::Index{point.nodes[i]} + 2, mode);
      }
      return sum / largest;
    });
    map.panels.push_back(
        {fmt::format("{}: {:.1f} Hz", mode + 1, model.frequency_hz[mode]), values});
  }
  return map;
}

ColourMap map_of_strike(const core::VibratingPlate& plate, const core::Box& box,
                        const core::RenderSettings& settings, const PlateImpact& strike,
                        const std::string& title) {
  ColourMap map = empty_map(box, title);
  map.value_label = "displacement [um]";
  core::ModalState state{plate.model, settings.integrator, settings.dt_s};
  state.touch(plate.locator->locate(strike.at_m.x(), strike.at_m.y()), outward);
  state.strike(-settings.finger.mass_kg * strike.speed_m_s);
  for (int frame = 1; frame <= frames; ++frame) {
    state.tick();
    map.panels.push_back({fmt::format("{:.1f} ms", 1e3 * settings.dt_s * frame),
                          over_face(box, [&](double x, double y) {
                            state.touch(plate.locator->locate(x, y), outward);
                            return 1e6 * state.displacement_m();
                          })});
  }
  return map;
}
}  // namespace tapstudy::analysis
