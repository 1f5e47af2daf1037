#pragma once
#include <string>
#include <vector>

#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// The member of a stimulus's family that "--set name=value" options ask for. Where a table has
// another value, says so on standard error. Throws InvalidInput for a setting without a name or a
// number, a name set twice, and what presented_values refuses.
protocols::PresentedStimulus member_set_to(const std::vector<std::string>& settings,
                                           const protocols::Protocol& protocol,
                                           const protocols::Stimulus& stimulus);

inline constexpr const char* set_help =
    "NAME=VALUE: present the stimulus at this value of an axis of its vary; once for each axis";
}  // namespace tapstudy::runner
