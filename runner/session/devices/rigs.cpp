#include "runner/session/devices/rigs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/model/shape/shape.hpp"
#include "device/spidar/kinematics.hpp"
#include "protocols/reader/read_rig.hpp"
#include "protocols/yaml/text_file.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/masking_card.hpp"
namespace tapstudy::runner {
namespace {
constexpr device::Nanoseconds max_heartbeat_gap = 100'000'000;

// At least one, but for no time at all.
int ticks_in(double seconds, double rate_hz) {
  return seconds > 0.0 ? static_cast<int>(std::max(1LL, std::llround(seconds * rate_hz))) : 0;
}

std::vector<const protocols::RigDevice*> rig_devices() {
  return {device_kinds().begin(), device_kinds().end()};
}

// Every tapping point must lie where the device can go.
void check_workspace(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  const core::Placement placement = rig.placement.value_or(protocol.placement);
  std::string out_of_reach;
  for (const auto& [name, plate] : protocol.plates) {
    const core::TopHeight top{plate->shape};
    for (const auto& [point, at_m] : plate->tapping_points_m) {
      const auto z_m = top.at_m(at_m);
      const core::Vec3 on_device_m = placement.scaled(plate->lateral_ratio)
                                         .point_to_device({at_m.x(), at_m.y(), z_m.value_or(0.0)});
      const bool is_outside = on_device_m.norm() > rig.gate.workspace_radius_m;
      if (z_m && (is_outside || !kind_of(rig).reaches(rig, on_device_m))) {
        out_of_reach += fmt::format("\n  {} on plate '{}' is {:.1f} mm from the device's middle{}",
                                    point, name, 1e3 * on_device_m.norm(),
                                    is_outside ? "" : ", where the device cannot hold its grip");
      }
    }
  }
  if (!out_of_reach.empty()) {
    throw core::InvalidInput{
        fmt::format("these tapping points lie beyond workspace_radius_m, {:.1f} mm, or the "
                    "device's reach (lower lateral_scale, in placement {}, or move origin_m):{}",
                    1e3 * rig.gate.workspace_radius_m, placement.lateral_scale, out_of_reach)};
  }
}
}  // namespace

protocols::Rig parse_rig(const std::string& text, const std::string& file) {
  return protocols::parse_rig(text, file, rig_devices());
}

protocols::Rig read_rig(const std::string& file) {
  return parse_rig(protocols::contents_of(file), file);
}

std::string rig_schema() {
  return protocols::rig_schema(rig_devices());
}
std::string calibration_schema() {
  return protocols::calibration_schema(device::spidar_types());
}

std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file) {
  return protocols::rig_keys_asked_for(text, file, rig_devices());
}

protocols::Rig simulated_rig() {
  return parse_rig(
      "format: tapstudy-rig/1\n"
      "device: simulated_hand\n"
      "max_force_n: 10\n"
      "max_force_rate_n_per_s: 10000\n",
      "simulated rig");
}

device::LoopSettings loop_settings(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  device::LoopSettings settings;
  settings.period = std::llround(1e9 / protocol.rate_hz);
  settings.gate = rig.gate;
  settings.max_late_in_a_row = ticks_in(rig.max_late_s, protocol.rate_hz);
  settings.max_stall = std::llround(1e9 * rig.max_stall_s);
  settings.max_missed_share = rig.max_missed_share;
  if (rig.has_hardware) {
    settings.max_heartbeat_gap = max_heartbeat_gap;
  }
  settings.placement = rig.placement.value_or(protocol.placement);
  for (const auto& [name, plate] : protocol.plates) {
    const double scale = settings.placement.scaled(plate->lateral_ratio).lateral_scale;
    if (std::abs(scale - 1.0) > 1e-12 && std::holds_alternative<core::Solid>(plate->shape)) {
      throw core::InvalidInput{
          fmt::format("rig: a lateral scale of {} is not allowed with plate '{}' (1: only a "
                      "flat plate can be scaled sideways)",
                      scale, name)};
    }
  }
  return settings;
}

void check_fits(const protocols::Protocol& protocol, const protocols::Rig& rig) {
  check_workspace(protocol, rig);
  kind_of(rig).check(rig);
  check_masking(protocol, rig);
  check_actuator(protocol, rig);
}
}  // namespace tapstudy::runner
