#include "runner/simulated/tap_drawing.hpp"

#include <algorithm>
namespace tapstudy::runner {
namespace {
constexpr double timing_spread = 0.1;  // of the logarithm of dwell and pause

// No tap misses: on the smallest plate of the protocol, a hair inside its edge.
Eigen::Vector2d half_size_m(const protocols::Protocol& protocol) {
  Eigen::Vector2d half = Eigen::Vector2d::Constant(1e3);
  for (const auto& [name, plate] : protocol.plates) {
    half = half.cwiseMin(0.999 * plate.box.high_m().head<2>());
  }
  return half;
}
}  // namespace

std::vector<core::Vec3> aims_m(const protocols::Protocol& protocol,
                               const core::Placement& placement) {
  std::vector<core::Vec3> aims;
  for (const std::string& name : protocol.simulation.taps.points) {
    const Eigen::Vector2d& at_m = protocol.tapping_points_m.at(name);
    aims.push_back(placement.point_to_device({at_m.x(), at_m.y(), 0.0}));
  }
  return aims;
}

std::vector<device::PlannedTap> draw_taps(const protocols::Protocol& protocol,
                                          const core::Placement& placement, int count,
                                          core::Rng& rng) {
  const protocols::SimulatedTapSettings& settings = protocol.simulation.taps;
  const Eigen::Vector2d half_m = half_size_m(protocol);
  std::vector<std::string> round;
  std::vector<device::PlannedTap> taps;
  for (int i = 0; i < count; ++i) {
    if (round.empty()) {
      round = settings.points;
      rng.shuffle(round);
    }
    Eigen::Vector2d at_m = protocol.tapping_points_m.at(round.back());
    round.pop_back();
    at_m.x() += settings.scatter_m * rng.normal();
    at_m.y() += settings.scatter_m * rng.normal();
    at_m = at_m.cwiseMax(-half_m).cwiseMin(half_m);
    device::PlannedTap tap;
    tap.point_m = placement.point_to_device({at_m.x(), at_m.y(), 0.0});
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
}  // namespace tapstudy::runner
