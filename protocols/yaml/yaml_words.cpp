#include "protocols/yaml/yaml_words.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>

#include "core/plain_text.hpp"
namespace tapstudy::protocols {
namespace {
constexpr std::size_t max_echo = 60;
}

std::string printable(const std::string& text) {
  std::string safe = core::shortened(text, max_echo);
  std::ranges::replace_if(
      safe, [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
  return safe;
}

std::string kind_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Undefined:
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Scalar:
      return fmt::format("'{}'", printable(node.Scalar()));
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
  }
  return "something else";
}
}  // namespace tapstudy::protocols
