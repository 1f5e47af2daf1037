#pragma once
#include <vector>

#include "core/haptic_state.hpp"
#include "core/tick/spsc_ring.hpp"
namespace tapstudy::testing {
// What a loop has traced since the last call.
inline std::vector<core::TraceSample> samples_of(core::SpscRing<core::TraceSample>& trace) {
  std::vector<core::TraceSample> all;
  core::TraceSample sample{};
  while (trace.try_pop(sample)) {
    all.push_back(sample);
  }
  return all;
}
}  // namespace tapstudy::testing
