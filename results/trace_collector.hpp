#pragma once
#include <vector>

#include "core/haptic_state.hpp"
#include "core/tick/trace_ring.hpp"
#include "results/rows.hpp"
namespace tapstudy::results {
// Collects one trial's samples from the haptic thread's ring for the store: encodes them in chunks
// as they arrive and extracts the events (contacts, impacts, switches).
class TraceCollector {
 public:
  explicit TraceCollector(core::SpscRing<core::TraceSample>& ring) : ring_{&ring} {}
  void drain();
  // Empties the ring and discards its contents.
  void discard();
  // Drains the remaining samples and returns everything.
  struct Collected {
    std::vector<TraceChunk> chunks;
    std::vector<EventRow> events;
    std::int64_t ticks{};
    double duration_s{};
  };
  Collected finish();

 private:
  void note_events(const core::TraceSample& sample);
  void pack();

  core::SpscRing<core::TraceSample>* ring_;
  std::vector<core::TraceSample> pending_;
  Collected collected_;
  core::TraceSample previous_{};
  bool has_previous_{false};
};
}  // namespace tapstudy::results
