#pragma once
#include <string>
namespace YAML {  // NOLINT(readability-identifier-naming): the library's own name
class Node;
}
namespace tapstudy::protocols {
// What a message may repeat of a file: short, and nothing that would move a terminal's cursor.
std::string printable(const std::string& text);
// How a message calls a value: 'text', a list, a mapping, nothing.
std::string kind_of(const YAML::Node& node);
}  // namespace tapstudy::protocols
