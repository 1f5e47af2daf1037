#pragma once
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
namespace tapstudy::core {
// Whether the text can be stored and shown: UTF-8 (RFC 3629), no control characters but line breaks
// and tabs.
bool is_plain_text(std::string_view text);
// The text without spaces, tabs and line breaks at its ends.
std::string trimmed(std::string_view text);
// The text with its ASCII letters in lower case.
std::string lower_case(std::string_view text);
// Characters of plain text, each of one code point.
std::size_t character_count(std::string_view text);
// The first characters, as many as fit into so many bytes: none is cut in two.
std::string cut_to(std::string_view text, std::size_t max_bytes);
// The same, with "…" after what was cut.
std::string shortened(std::string_view text, std::size_t max_bytes);
// A name of unknown length in a message: in single quotes, shortened to 60 bytes.
std::string quoted_name(std::string_view name);
// The text as one word of a POSIX shell, in single quotes where it needs them.
std::string shell_word(std::string_view text);

// The whole text as a number, in any locale: "12", "-0.5", "1e9"; for floating point also "inf" and
// "nan". No sign +, no blanks around it. Unset if it is anything else or out of the type's range.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && stopped == end ? std::optional{number} : std::nullopt;
}

// "0.1,0.05", "20:2000": two numbers around a separator.
inline std::optional<std::pair<double, double>> two_numbers_in(std::string_view text,
                                                               char separator) {
  const auto at = text.find(separator);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  const auto first = number_in<double>(text.substr(0, at));
  const auto second = number_in<double>(text.substr(at + 1));
  return first && second ? std::optional{std::pair{*first, *second}} : std::nullopt;
}
}  // namespace tapstudy::core
