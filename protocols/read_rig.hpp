#pragma once
#include <set>
#include <span>
#include <string>

#include "protocols/rig_device.hpp"
namespace tapstudy::protocols {
using RigDevices = std::span<const RigDevice* const>;

// The rig in a YAML text; `file` is its name in messages, and where the names of other files start
// from. Throws InvalidInput with every problem of the file, one a line.
Rig parse_rig(const std::string& text, const std::string& file, RigDevices devices);
// Every key that the reader asked for while reading this text, for the schema's test.
std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file,
                                         RigDevices devices);
}  // namespace tapstudy::protocols
