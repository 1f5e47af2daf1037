#pragma once
#include <optional>
#include <set>
#include <span>
#include <string>

#include "protocols/rig_device.hpp"
namespace tapstudy::protocols {
using RigDevices = std::span<const RigDevice* const>;

// Parses a rig from YAML; `file` is its name in messages, and other file names are relative to it.
// Throws InvalidInput listing every problem of the file, one per line.
Rig parse_rig(const std::string& text, const std::string& file, RigDevices devices);
// Every key that the reader asked for while reading this text, for the schema's test.
std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file,
                                         RigDevices devices);
// Where the plate lies, of the text that a session stores: its rig, and after "---" the device's
// calibration. nullopt: where the protocol says; also of an empty text. Throws InvalidInput if that
// text is broken.
std::optional<core::Placement> placement_in_stored_rig(const std::string& rig_text);
}  // namespace tapstudy::protocols
