#pragma once
#include <string>
namespace tapstudy::protocols {
// What an error of the YAML parser, which notices it late, is likely to come from. error_line: from
// 0.
std::string likely_cause(const std::string& text, int error_line);
}  // namespace tapstudy::protocols
