#include "runner/session/participants/planned_taps.hpp"

#include <algorithm>
#include <optional>

#include "core/model/shape/shape.hpp"
namespace tapstudy::runner {
namespace {
constexpr double timing_spread = 0.1;  // of the logarithm of dwell and pause

// In the order of the stimuli; what a plate only touches (contacts) is never tapped.
std::vector<const protocols::Plate*> tapped_plates(const protocols::Protocol& protocol) {
  std::vector<const protocols::Plate*> plates;
  for (const protocols::Stimulus& stimulus : protocol.stimuli) {
    if (std::ranges::find(plates, stimulus.plate.get()) == plates.end()) {
      plates.push_back(stimulus.plate.get());
    }
  }
  return plates;
}

// Where taps may land: on every plate that is tapped, in the plate frame at the placement's scale.
// They agree on their heights at the tapping points.
class TapArea {
 public:
  explicit TapArea(const protocols::Protocol& protocol) {
    for (const protocols::Plate* const plate : tapped_plates(protocol)) {
      half_m_ = half_m_.cwiseMin(0.999 * plate->lateral_ratio *
                                 core::bounds(plate->shape).high_m.head<2>());
      is_flat_ = is_flat_ && std::holds_alternative<core::Box>(plate->shape);
      plates_.push_back({core::TopHeight{plate->shape}, plate->lateral_ratio});
    }
  }
  // Every tap lands on the plate: the drawn point, else clamped to just inside the edge of the
  // smallest plate, or, if that is off some body, the target point.
  core::Vec3 landing_m(const Eigen::Vector2d& place_m, const Eigen::Vector2d& aim_m) const {
    if (is_flat_) {
      const Eigen::Vector2d inside_m = place_m.cwiseMax(-half_m_).cwiseMin(half_m_);
      return {inside_m.x(), inside_m.y(), 0.0};
    }
    const bool is_on_all = std::ranges::all_of(
        plates_, [&](const Top& plate) { return plate.height_m(place_m).has_value(); });
    const Eigen::Vector2d& at_m = is_on_all ? place_m : aim_m;
    return {at_m.x(), at_m.y(), plates_.front().height_m(at_m).value_or(0.0)};
  }

 private:
  struct Top {
    core::TopHeight height;
    double lateral_ratio;
    std::optional<double> height_m(const Eigen::Vector2d& at_m) const {
      return height.at_m(at_m / lateral_ratio);
    }
  };
  Eigen::Vector2d half_m_{Eigen::Vector2d::Constant(1e3)};
  bool is_flat_{true};
  std::vector<Top> plates_;
};
}  // namespace

core::Vec3 point_on_surface_m(const protocols::Protocol& protocol, const std::string& point) {
  const Eigen::Vector2d& at_m = protocol.tapping_points_m.at(point);
  return TapArea{protocol}.landing_m(at_m, at_m);
}

std::vector<core::Vec3> aims_m(const protocols::Protocol& protocol,
                               const core::Placement& placement) {
  const TapArea area{protocol};
  std::vector<core::Vec3> aims;
  for (const std::string& name : protocol.simulation.taps.points) {
    const Eigen::Vector2d& at_m = protocol.tapping_points_m.at(name);
    aims.push_back(placement.point_to_device(area.landing_m(at_m, at_m)));
  }
  return aims;
}

std::vector<device::PlannedTap> draw_taps(const protocols::Protocol& protocol,
                                          const protocols::SimulatedTapSettings& settings,
                                          const core::Placement& placement, int count,
                                          core::Rng& rng) {
  const TapArea area{protocol};
  std::vector<std::string> round;
  std::vector<device::PlannedTap> taps;
  for (int i = 0; i < count; ++i) {
    if (round.empty()) {
      round = settings.points;
      rng.shuffle(round);
    }
    const Eigen::Vector2d aim_m = protocol.tapping_points_m.at(round.back());
    Eigen::Vector2d at_m = aim_m;
    round.pop_back();
    at_m.x() += settings.scatter_m * rng.normal();
    at_m.y() += settings.scatter_m * rng.normal();
    device::PlannedTap tap;
    tap.point_m = placement.point_to_device(area.landing_m(at_m, aim_m));
    tap.speed_m_s = rng.log_normal(settings.speed_m_s, settings.speed_spread);
    tap.hover_m = settings.hover_m;
    tap.run_up_m = 0.5 * settings.hover_m;
    tap.press_m = settings.press_m;
    tap.dwell_s = rng.log_normal(settings.dwell_s, timing_spread);
    tap.pause_s = rng.log_normal(settings.pause_s, timing_spread);
    taps.push_back(tap);
  }
  return taps;
}

std::optional<device::RepeatedTap> scripted_tap(
    const protocols::Protocol& protocol, const std::optional<protocols::ScriptedTaps>& taps) {
  if (!taps) {
    return std::nullopt;
  }
  return device::RepeatedTap{protocol.simulation.hand, point_on_surface_m(protocol, taps->point),
                             taps->speed_m_s, taps->dwell_s, taps->pause_s};
}
}  // namespace tapstudy::runner
