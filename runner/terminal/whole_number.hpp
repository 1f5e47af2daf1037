#pragma once
#include <optional>
#include <string_view>
namespace tapstudy::runner {
// The text as a whole number, if it is one and nothing else, from low to high.
std::optional<int> whole_number(std::string_view text, int low, int high);
}  // namespace tapstudy::runner
