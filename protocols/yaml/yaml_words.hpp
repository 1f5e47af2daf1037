#pragma once
#include <string>
namespace YAML {  // NOLINT(readability-identifier-naming): the library's own name
class Node;
}
namespace tapstudy::protocols {
// Text from a file made safe to quote in a message: short, without terminal control characters.
std::string printable(const std::string& text);
// A value as described in messages: 'text', a list, a mapping, nothing.
std::string kind_of(const YAML::Node& node);
}  // namespace tapstudy::protocols
