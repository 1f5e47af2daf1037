#pragma once
#include <set>
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::protocols {
// The study in a YAML text; `file` is its name in messages, and surfaces lie beside it.
// Throws InvalidInput with every problem of the file, one a line.
Protocol parse_protocol(const std::string& text, const std::string& file);

// The same with surfaces from elsewhere: those that are stored with a study.
Protocol parse_protocol(const std::string& text, const std::string& file,
                        const ReadFile& read_file);

// The same from a file. Throws InvalidInput also if it cannot be read.
Protocol read_protocol(const std::string& file);

// Every key the protocol reader asked for in this text (`*` any name, `[]` any place in a list).
std::set<std::string> keys_asked_for(const std::string& text, const std::string& file);
}  // namespace tapstudy::protocols
