#include "analysis/blocks/text_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "analysis/blocks/wording.hpp"
namespace tapstudy::analysis {
std::size_t text_width(const std::string& text) {
  constexpr int marks = 0xC0;  // the bytes of a character after its first are 10xxxxxx
  constexpr int continued = 0x80;
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char byte) { return (byte & marks) != continued; }));
}

std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words{text};
  std::string lines;
  std::string line(indent, ' ');
  bool is_empty = true;
  for (std::string word; words >> word;) {
    if (!is_empty && text_width(line) + 1 + text_width(word) > terminal_columns) {
      lines += line + '\n';
      line = std::string(indent + 2, ' ');
      is_empty = true;
    }
    line += (is_empty ? "" : " ") + word;
    is_empty = false;
  }
  return lines + line + '\n';
}

void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses) {
  for (const HypothesisResult& result : hypotheses) {
    const std::string adjusted =
        result.p_holm ? fmt::format(", {} after Holm 1979", p_value(*result.p_holm)) : "";
    out << wrapped(result.planned.statement, 2)
        << wrapped(result.p ? fmt::format("{} against {:.0f} % by chance: {} ({}){}",
                                          fraction(result.observed), 100.0 * result.chance,
                                          p_value(result), result.test, adjusted)
                            : "not tested: " + result.test,
                   4);
  }
}
}  // namespace tapstudy::analysis
