#include "runner/studies/shares/share.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::runner {
Share share_from(const std::string& text) {
  const std::string_view whole{text};
  const auto at = whole.find('/');
  const auto number = core::number_in<int>(whole.substr(0, at));
  const auto of = at == std::string_view::npos ? std::optional<int>{}
                                               : core::number_in<int>(whole.substr(at + 1));
  if (!number || !of || *number < 1 || *number > *of) {
    throw core::InvalidInput{
        fmt::format("--share: '{}' is not allowed (K/N: share K, from 1 to N, of N shares)", text)};
  }
  return {*number, *of};
}

std::string to_text(const Share& share) {
  return fmt::format("{}/{}", share.number, share.of);
}

SharedOut part_of(const Share& share, int count, const std::string& what) {
  if (share.of > count) {
    throw core::InvalidInput{
        fmt::format("--share: {} {} make no {} shares (at most {})", count, what, share.of, count)};
  }
  const auto end_of = [&](int number) {
    return static_cast<int>(std::int64_t{count} * number / share.of);
  };
  return {end_of(share.number - 1), end_of(share.number)};
}
}  // namespace tapstudy::runner
