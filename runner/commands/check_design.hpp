#pragma once
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// Prints what a study asks of so many participants: blocks with chance and power, masking, the
// screens of one participant, languages. actuator_rate_hz: of the card on which what lies above the
// crossover is rendered, if anything does.
void print_design(const protocols::Protocol& protocol, int participants, double actuator_rate_hz);
}  // namespace tapstudy::runner
