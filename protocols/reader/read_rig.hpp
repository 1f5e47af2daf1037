#pragma once
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "core/settings/device_settings.hpp"
#include "protocols/rig.hpp"
namespace tapstudy::protocols {
class MapReader;

// The base directory of a section's file names, and the rig's source text, to which the contents of
// other files are appended.
struct RigText {
  std::string directory;
  std::string* text{};
};

// A kind of device as the reader of rigs sees it. The kinds themselves are in runner/devices.
class RigDevice {
 public:
  virtual ~RigDevice() = default;
  virtual std::string_view name() const = 0;  // in rigs
  // Whether it exerts force on a person's hand: then the rig must limit the hand's motion.
  virtual bool has_hardware() const = 0;
  // Reads its section of the rig, if it has one; problems go to the reader.
  virtual std::shared_ptr<const DeviceSection> read_section(MapReader& top,
                                                            const RigText& rig) const = 0;
};

using RigDevices = std::span<const RigDevice* const>;

// Parses a rig from YAML; `file` is its name in messages, and other file names are relative to it.
// Throws InvalidInput listing every problem of the file, one per line.
Rig parse_rig(const std::string& text, const std::string& file, RigDevices devices);
// Every key that the reader asked for while reading this text, for the schema's test.
std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file,
                                         RigDevices devices);
// The JSON schemas of a rig and of a calibration for frames of these types.
std::string rig_schema(RigDevices devices);
std::string calibration_schema(const std::vector<std::string>& types);
// Where the plate lies, of the text that a session stores: its rig, and after "---" the device's
// calibration. nullopt: where the protocol says; also of an empty text. Throws InvalidInput if that
// text is broken.
std::optional<core::Placement> placement_in_stored_rig(const std::string& rig_text);
// Likewise the actuator beside the device; nullopt: there was none.
std::optional<core::ActuatorOutput> actuator_in_stored_rig(const std::string& rig_text);

// The calibration of one SPIDAR, a file of its own: all rigs on that device share it.

// Throws InvalidInput with every problem of the text, one a line, or if it is for a frame of
// another type.
core::SpidarCalibration parse_calibration(const std::string& text, const std::string& file,
                                          const std::string& type);
void write_calibration(std::ostream& out, const std::string& type,
                       const core::SpidarCalibration& calibration);
// Every key that the reader asked for while reading this text, for the schema's test.
std::set<std::string> calibration_keys_asked_for(const std::string& text, const std::string& file);
}  // namespace tapstudy::protocols
