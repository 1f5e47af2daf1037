#include "protocols/yaml/likely_cause.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
namespace tapstudy::protocols {
std::string likely_cause(const std::string& text, int error_line) {
  std::istringstream lines{text};
  std::string line;
  for (int number = 1; number <= error_line + 1 && std::getline(lines, line); ++number) {
    const auto indentation = line.find_first_not_of(" \t");
    if (line.substr(0, std::min(indentation, line.size())).find('\t') != std::string::npos) {
      return fmt::format("line {} is indented with a tab: use spaces", number);
    }
    if (line.find_first_of("#'") == std::string::npos && std::ranges::count(line, '"') % 2 == 1) {
      return fmt::format("is the quote in line {} closed?", number);
    }
  }
  return "is this line indented like its neighbours? A text with any of ? : , # [ { goes in quotes";
}
}  // namespace tapstudy::protocols
