#pragma once
#include <string>
namespace tapstudy::core {
// SHA-256 in lower-case hexadecimal, as sha256sum prints it.
std::string sha256(const std::string& text);
}  // namespace tapstudy::core
