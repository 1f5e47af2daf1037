#pragma once
#include <string>

#include "protocols/protocol.hpp"
namespace tapstudy::runner {
inline constexpr const char* participants_help =
    "How many are planned; unset: the protocol's `participants`, or 10";
// The number given with --participants, or what help says if it is empty. Throws InvalidInput.
int planned_participants(const std::string& given, const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
