#pragma once
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// Prints what a study asks of so many participants: blocks with chance and power, masking, the
// screens of one participant, languages.
void print_design(const protocols::Protocol& protocol, int participants);
}  // namespace tapstudy::runner
