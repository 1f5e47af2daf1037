#pragma once
#include <fmt/format.h>

#include <ostream>
#include <utility>
namespace tapstudy::core {
// Prints as fmt::print to a stream, without instantiating the whole formatter in every source file.
template <class... Parts>
void print(std::ostream& out, fmt::format_string<Parts...> format, Parts&&... parts) {
  out << fmt::format(format, std::forward<Parts>(parts)...);
}
}  // namespace tapstudy::core
