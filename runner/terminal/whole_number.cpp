#include "runner/terminal/whole_number.hpp"

#include <charconv>
namespace tapstudy::runner {
std::optional<int> whole_number(std::string_view text, int low, int high) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  const bool is_allowed = error == std::errc{} && stopped == end && number >= low && number <= high;
  return is_allowed ? std::optional{number} : std::nullopt;
}
}  // namespace tapstudy::runner
