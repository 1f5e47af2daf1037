#include "runner/commands/planned_participants.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "runner/terminal/whole_number.hpp"
namespace tapstudy::runner {
int planned_participants(const std::string& given, const protocols::Protocol& protocol) {
  constexpr int usual = 10;
  if (given.empty()) {
    return protocol.participants.value_or(usual);
  }
  const auto number = whole_number(given, 1, protocols::max_participants);
  if (!number) {
    throw core::InvalidInput{fmt::format("--participants: {} is not allowed (from 1 to {})", given,
                                         protocols::max_participants)};
  }
  return *number;
}
}  // namespace tapstudy::runner
