#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "protocols/axes/presented_stimulus.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// A whole number from 0 to 2^64 - 1. Throws InvalidInput naming the option if the text is not one.
std::uint64_t seed_from(const std::string& text, const std::string& option);

inline constexpr const char* participants_help =
    "How many are planned; unset: the protocol's `participants`, or 10";
// The number given with --participants, or what help says if it is empty. Throws InvalidInput.
int planned_participants(const std::string& given, const protocols::Protocol& protocol);

// The member of a stimulus's family that "--set name=value" options ask for. Where a table has
// another value, says so on standard error. Throws InvalidInput for a setting without a name or a
// number, a name set twice, and what presented_values refuses.
protocols::PresentedStimulus member_set_to(const std::vector<std::string>& settings,
                                           const protocols::Protocol& protocol,
                                           const protocols::Stimulus& stimulus);

inline constexpr const char* set_help =
    "NAME=VALUE: present the stimulus at this value of an axis of its vary; once for each axis";
}  // namespace tapstudy::runner
