#include "results/export/tsv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
namespace tapstudy::results {
namespace {
struct TextOf {
  std::string operator()(std::monostate /*missing*/) const { return missing_in_tsv; }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const {
    return std::isnan(number) ? missing_in_tsv : fmt::format("{}", number);
  }
  std::string operator()(std::string text) const {
    std::ranges::replace_if(
        text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    return text.empty() ? missing_in_tsv : text;
  }
};
}  // namespace

std::string tsv_line(const Row& row) {
  std::string line;
  for (const Cell& cell : row) {
    if (!line.empty()) {
      line += '\t';
    }
    line += std::visit(TextOf{}, cell);
  }
  return line + '\n';
}
}  // namespace tapstudy::results
