#pragma once
#include <set>
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
struct StudyText {
  std::string text;        // YAML
  std::string file;        // its name in messages; surface paths are relative to it
  std::string language{};  // of what participants read; else, of each text, the first that it has
};

// Parses a study from YAML.
// Throws InvalidInput listing every problem of the file, one per line.
Protocol parse_protocol(const std::string& text, const std::string& file);

// The same with surfaces from elsewhere: those that are stored with a study.
Protocol parse_protocol(const StudyText& study, const ReadFile& read_file);

// The same from a file. Throws InvalidInput also if it cannot be read.
Protocol read_protocol(const std::string& file, const std::string& language = {});

// The JSON schema of a protocol.
std::string protocol_schema();
// Every key the protocol reader looked up in this text (`*` any name, `[]` any list index).
std::set<std::string> keys_asked_for(const std::string& text, const std::string& file);
}  // namespace tapstudy::protocols
