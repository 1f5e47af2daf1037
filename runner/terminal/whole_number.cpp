#include "runner/terminal/whole_number.hpp"

#include "core/number_in.hpp"

namespace tapstudy::runner {
std::optional<int> whole_number(std::string_view text, int low, int high) {
  const auto number = core::number_in<int>(text);
  return number && *number >= low && *number <= high ? number : std::nullopt;
}
}  // namespace tapstudy::runner
