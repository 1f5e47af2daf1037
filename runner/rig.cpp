#include "runner/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/model/shape/top_height.hpp"
namespace tapstudy::runner {
namespace {
constexpr device::Nanoseconds longest_without_beat = 100'000'000;
constexpr double largest_ratio = 3.0;

// Every tapping point must lie where the device can go.
void check_workspace(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  const core::Placement placement = rig.placement.value_or(protocol.placement);
  std::string out_of_reach;
  for (const auto& [plate, spec] : protocol.plates) {
    const core::TopHeight top{spec.shape};
    for (const auto& [point, at_m] : protocol.tapping_points_m) {
      const auto z_m = top.at_m(at_m);
      const core::Vec3 on_device_m =
          placement.point_to_device({at_m.x(), at_m.y(), z_m.value_or(0.0)});
      if (z_m && on_device_m.norm() > rig.workspace_radius_m) {
        out_of_reach += fmt::format("\n  {} on plate '{}' is {:.1f} mm from the device's middle",
                                    point, plate, 1e3 * on_device_m.norm());
      }
    }
  }
  if (!out_of_reach.empty()) {
    throw core::InvalidInput{
        fmt::format("these tapping points lie beyond workspace_radius_m, {:.1f} mm (lower "
                    "placement.lateral_scale, {}, or move origin_m):{}",
                    1e3 * rig.workspace_radius_m, placement.lateral_scale, out_of_reach)};
  }
}

void check_alike(const char* what, std::array<double, 8> of_string) {
  for (double& value : of_string) {
    value = std::abs(value);
  }
  const auto [least, most] = std::ranges::minmax_element(of_string);
  if (*most > largest_ratio * *least) {
    throw core::InvalidInput{fmt::format(
        "calibration: {} is {:.3g} for string {} and {:.3g} for string {} (motors of one kind do "
        "not differ more than threefold: measure again)",
        what, *least, least - of_string.begin() + 1, *most, most - of_string.begin() + 1)};
  }
}
// Eight motors of one kind are alike, and the largest tension takes no more digits than there are.
void check_strings(const protocols::SpidarRig& rig) {
  std::array<double, 8> metres_per_count{};
  std::array<double, 8> digits_per_newton{};
  for (std::size_t i = 0; i < rig.strings.size(); ++i) {
    metres_per_count.at(i) = rig.strings.at(i).metres_per_count;
    digits_per_newton.at(i) =
        rig.strings.at(i).volts_per_newton * rig.strings.at(i).digits_per_volt;
  }
  check_alike("metres_per_count", metres_per_count);
  check_alike("volts_per_newton times digits_per_volt", digits_per_newton);
  const double most_digits = rig.max_tension_n * std::ranges::max(digits_per_newton);
  if (most_digits > device::most_digits) {
    throw core::InvalidInput{
        fmt::format("calibration: max_tension_n, {} N, would take {:.0f} digits (the board has {}: "
                    "lower it, or measure again)",
                    rig.max_tension_n, most_digits, device::most_digits)};
  }
}
}  // namespace

device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  device::LoopSettings settings;
  settings.period = std::llround(1e9 / protocol.rate_hz);
  settings.gate.limits = rig.limits;
  settings.gate.max_speed_m_s = rig.max_hand_speed_m_s;
  settings.gate.workspace_radius_m = rig.workspace_radius_m;
  settings.gate.rise_s = rig.force_rise_s;
  settings.gate.fall_s = rig.force_fall_s;
  settings.most_late_in_a_row = rig.loop.most_late_ticks_in_a_row;
  if (rig.has_hardware()) {
    settings.longest_without_beat = longest_without_beat;
  }
  settings.placement = rig.placement.value_or(protocol.placement);
  for (const auto& [name, plate] : protocol.plates) {
    if (settings.placement.lateral_scale != 1.0 &&
        std::holds_alternative<core::Solid>(plate.shape)) {
      throw core::InvalidInput{
          fmt::format("rig: placement.lateral_scale: {} is not allowed with plate '{}' (1: only a "
                      "flat plate can "
                      "be scaled sideways)",
                      settings.placement.lateral_scale, name)};
    }
  }
  return settings;
}

void check_fits(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  check_workspace(protocol, rig);
  if (rig.spidar) {
    check_strings(*rig.spidar);
  }
}

device::SpidarSettings spidar_settings(const protocols::SpidarRig& rig, double dt_s) {
  device::SpidarSettings settings;
  settings.geometry = device::spidar_geometry(rig.type);
  for (std::size_t i = 0; i < rig.strings.size(); ++i) {
    const protocols::StringRig& string = rig.strings.at(i);
    settings.calibration.string.at(i) = {string.metres_per_count, string.volts_per_newton,
                                         string.digits_per_volt};
  }
  settings.calibration.range = {rig.min_tension_n, rig.max_tension_n};
  settings.limits.largest_turn_rad = rig.max_turn_rad;
  settings.dt_s = dt_s;
  return settings;
}

device::RealtimeRequest realtime_request(const protocols::LoopRig& rig) {
  return {rig.fifo_priority, rig.lock_memory, rig.cpu};
}

device::HandBody hand_body(const protocols::SimulatedHandSettings& hand) {
  return {hand.mass_kg, hand.muscle_stiffness_n_per_m, hand.muscle_damping_n_s_per_m};
}
}  // namespace tapstudy::runner
