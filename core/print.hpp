#pragma once
#include <fmt/format.h>

#include <ostream>
#include <utility>
namespace tapstudy::core {
// fmt::print on a stream says the same, but compiles its whole formatter into every source.
template <class... Parts>
void print(std::ostream& out, fmt::format_string<Parts...> format, Parts&&... parts) {
  out << fmt::format(format, std::forward<Parts>(parts)...);
}
}  // namespace tapstudy::core
