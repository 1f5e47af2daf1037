#include "runner/commands/seed.hpp"

#include <fmt/format.h>

#include <charconv>

#include "core/error.hpp"
namespace tapstudy::runner {
std::uint64_t seed_from(const std::string& text, const std::string& option) {
  std::uint64_t seed{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, seed);
  if (error != std::errc{} || stopped != end) {
    throw core::InvalidInput{
        fmt::format("{}: '{}' is not a whole number from 0 to 2^64 - 1", option, text)};
  }
  return seed;
}
}  // namespace tapstudy::runner
