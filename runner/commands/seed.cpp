#include "runner/commands/seed.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::runner {
std::uint64_t seed_from(const std::string& text, const std::string& option) {
  const auto seed = core::number_in<std::uint64_t>(text);
  if (!seed) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' is not a whole number from 0 to 2^64 - 1", option, text)};
  }
  return *seed;
}
}  // namespace tapstudy::runner
