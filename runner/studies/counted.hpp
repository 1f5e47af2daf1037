#pragma once
#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
namespace tapstudy::runner {
// "1 trial", "8 trials"
inline std::string counted(std::size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}
}  // namespace tapstudy::runner
