#pragma once
#include <string>

#include "core/tick_fault.hpp"
namespace tapstudy::runner {
// A trial ended by a fault, and stored. The fault may have occurred after the answer.
struct Interruption {
  int trial{};
  core::TickFault fault{};
  bool is_answered{};
  bool is_force_off{};  // confirmed by the device, or taken from its guardian
};
std::string to_text(const Interruption& interruption);
}  // namespace tapstudy::runner
