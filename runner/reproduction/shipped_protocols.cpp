#include "runner/reproduction/shipped_protocols.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
namespace tapstudy::runner {
namespace {
using Named = std::pair<std::string_view, std::string_view>;  // file, text
constexpr auto embedded = std::to_array<Named>({
#include "embedded_protocols.inc"
});
}  // namespace

std::string shipped_text(const std::string& file) {
  const auto* const found = std::ranges::find(embedded, file, &Named::first);
  if (found == embedded.end()) {
    throw core::InvalidInput{file + ": is not shipped with this program"};
  }
  return std::string{found->second};
}

protocols::Protocol shipped_protocol(const std::string& file) {
  return protocols::parse_protocol(shipped_text(file), file);
}
}  // namespace tapstudy::runner
