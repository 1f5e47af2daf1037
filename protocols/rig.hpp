#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/placement.hpp"
#include "core/settings/gate_settings.hpp"
#include "core/settings/realtime_request.hpp"
namespace tapstudy::protocols {
// What one kind of device has of its own in a rig. Each kind derives its settings from this.
struct DeviceSection {
  virtual ~DeviceSection() = default;
};

// What surrounds the study: the device and what it may do.
struct Rig {
  std::string text;    // all that it was read from, a calibration as a second document
  std::string device;  // the name of its kind
  std::shared_ptr<const DeviceSection> section;  // nothing for a kind without settings
  bool has_hardware{};                           // it pushes on a person's hand
  core::GateSettings gate;
  core::RealtimeRequest realtime;
  int max_late_ticks_in_a_row{0};            // 0: any
  std::optional<core::Placement> placement;  // instead of the protocol's
};
}  // namespace tapstudy::protocols
