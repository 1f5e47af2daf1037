#include "analysis/figures/face_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/tick/modal_state.hpp"
namespace tapstudy::analysis {
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
