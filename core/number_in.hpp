#pragma once
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
namespace tapstudy::core {
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
