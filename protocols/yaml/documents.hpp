#pragma once
#include <string>
namespace tapstudy::protocols {
// Throws YAML::Exception if the text is not YAML.
bool holds_two_documents(const std::string& text);
}  // namespace tapstudy::protocols
