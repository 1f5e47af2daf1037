#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/haptics/haptic_state.hpp"
#include "core/settings/actuator_settings.hpp"
#include "core/settings/audio_settings.hpp"
#include "core/settings/device_settings.hpp"
#include "core/settings/render_settings.hpp"
namespace tapstudy::protocols {
// Base class of the device-specific settings in a rig.
struct DeviceSection {
  virtual ~DeviceSection() = default;
  // How long a tick may wait for the device; 0 for one that replies at once.
  virtual double max_reply_time_s() const { return 0.0; }
};

// Who is told of a session's changes of state: runner/session/markers/README.md.
struct OscTarget {
  std::string host{"127.0.0.1"};
  int port{};
};
struct LslStreams {
  std::string name{"tapstudy"};
  bool has_forces{false};  // a second stream, of every tick's force
};
struct MarkerSettings {
  std::optional<OscTarget> osc;
  std::optional<LslStreams> lsl{};
  std::string lines;  // serial port, named pipe or file; empty: none
};

// The device and its limits, independent of the study.
struct Rig {
  std::string text;    // complete source, with a calibration as second document
  std::string device;  // the name of its kind
  std::shared_ptr<const DeviceSection> section;  // null for a kind without settings
  bool has_hardware{};                           // exerts force on a person's hand
  core::GateSettings gate;
  std::optional<double> vibration_band_hz;  // the highest frequency that the device renders
  std::shared_ptr<const core::DeviceResponse> vibration_response;  // null: not measured
  core::RealtimeRequest realtime;
  double max_late_s{0.0};                        // while each tick is late; 0: any
  double max_stall_s{0.0};                       // between two ticks; 0: any
  double max_missed_share{1.0};                  // of the periods of a second; 1: any
  std::optional<core::Placement> placement;      // instead of the protocol's
  std::optional<core::AudioOutput> audio;        // where masking noise is played
  std::optional<core::ActuatorOutput> actuator;  // beside the device
  MarkerSettings markers;
};
}  // namespace tapstudy::protocols
