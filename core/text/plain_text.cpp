#include "core/text/plain_text.hpp"

#include <utf8cpp/utf8.h>

#include <algorithm>
#include <cctype>
namespace tapstudy::core {
namespace {
bool is_control(char32_t character) {
  return (character < 0x20 && character != U'\n' && character != U'\r' && character != U'\t') ||
         (character >= 0x7F && character < 0xA0);
}

bool continues_a_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}
}  // namespace

bool is_plain_text(std::string_view text) {
  if (!utf8::is_valid(text.begin(), text.end())) {
    return false;
  }
  const auto* at = text.begin();
  while (at != text.end()) {
    if (is_control(utf8::unchecked::next(at))) {
      return false;
    }
  }
  return true;
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view blanks{" \t\r\n"};
  const auto first = text.find_first_not_of(blanks);
  const auto last = text.find_last_not_of(blanks);
  return first == std::string_view::npos ? std::string{}
                                         : std::string{text.substr(first, last - first + 1)};
}

std::string lower_case(std::string_view text) {
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  std::string lower{text};
  for (char& c : lower) {
    c = is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return lower;
}

std::size_t character_count(std::string_view text) {
  return text.size() - static_cast<std::size_t>(std::ranges::count_if(text, continues_a_character));
}

std::string cut_to(std::string_view text, std::size_t max_bytes) {
  std::size_t end = std::min(text.size(), max_bytes);
  while (end > 0 && end < text.size() && continues_a_character(text[end])) {
    --end;
  }
  return std::string{text.substr(0, end)};
}

std::string shortened(std::string_view text, std::size_t max_bytes) {
  return text.size() <= max_bytes ? std::string{text} : cut_to(text, max_bytes) + "…";
}

std::string quoted_name(std::string_view name) {
  constexpr std::size_t longest = 60;
  return "'" + shortened(name, longest) + "'";
}

std::string shell_word(std::string_view text) {
  const bool is_plain = std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view{"._-+/"}.find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) {
    return std::string{text};
  }
  std::string quoted{"'"};
  for (const char c : text) {
    quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  }
  return quoted + "'";
}
}  // namespace tapstudy::core
