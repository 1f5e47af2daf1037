#pragma once
#include "protocols/protocol.hpp"
#include "runner/stimuli/model_library.hpp"
namespace tapstudy::runner {
// Prints the stimuli that vary: along what, how many models that takes, what these cost to solve
// and to hold, and how many modes the members have. Builds all models. Throws as build_all does.
void print_families(const protocols::Protocol& protocol, ModelLibrary& models);

// The stiffest contact of all members of all stimuli: its spring and what techniques add to it.
double largest_contact_stiffness_n_per_m(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
