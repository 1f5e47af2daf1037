#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
#include "protocols/surface/surface_soup.hpp"
#include "protocols/yaml/problems.hpp"
namespace tapstudy::protocols {
double coordinate_in(std::string_view word, const std::string& place) {
  const auto number = core::number_in<double>(word.starts_with('+') ? word.substr(1) : word);
  if (number && std::isfinite(*number)) {
    return *number;
  }
  const std::string quoted = printable(std::string{word});
  std::string with_point{word};
  std::ranges::replace(with_point, ',', '.');
  if (with_point != word && core::number_in<double>(with_point)) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' has a decimal comma (numbers have a decimal point here: {})", place,
                    quoted, with_point)};
  }
  throw core::InvalidInput{fmt::format("{}: '{}' is not a finite number", place, quoted)};
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view blanks{" \t\v\f"};
  std::vector<std::string_view> words;
  for (auto from = line.find_first_not_of(blanks); from != std::string_view::npos;
       from = line.find_first_not_of(blanks, from)) {
    const auto to = std::min(line.find_first_of(blanks, from), line.size());
    words.push_back(line.substr(from, to - from));
    from = to;
  }
  return words;
}

std::string_view take_line(std::string_view& text) {
  const auto end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  const bool is_two = text.substr(end).starts_with("\r\n");
  text.remove_prefix(std::min(text.size(), end + (is_two ? 2 : 1)));
  return line;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark{"\xEF\xBB\xBF"};
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}
}  // namespace tapstudy::protocols
