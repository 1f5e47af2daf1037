#pragma once
#include <set>
#include <string>

#include "protocols/rig.hpp"
namespace tapstudy::protocols {
// The rig in a YAML text; `file` is its name in messages, and where the name of a calibration file
// starts from. Throws InvalidInput with every problem of the file, one a line.
Rig parse_rig(const std::string& text, const std::string& file);
// The same from a file. Throws InvalidInput also if it cannot be read.
Rig read_rig(const std::string& file);
// The rig of a study without hardware: the simulated hand, 10 N.
Rig simulated_rig();
// Every key that the reader asked for while reading this text, for the schemas' test.
std::set<std::string> rig_keys_asked_for(const std::string& text, const std::string& file);
std::set<std::string> calibration_keys_asked_for(const std::string& text, const std::string& file);
}  // namespace tapstudy::protocols
