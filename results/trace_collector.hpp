#pragma once
#include <vector>

#include "core/haptic_state.hpp"
#include "core/tick/trace_ring.hpp"
#include "results/rows.hpp"
namespace tapstudy::results {
// One trial's samples on their way from the haptic thread's ring to the store: packed into chunks
// as they come, with the events that they show (contacts, impacts, switches).
class TraceCollector {
 public:
  explicit TraceCollector(core::SpscRing<core::TraceSample>& ring) : ring_{&ring} {}
  void drain();
  // Empties the ring and keeps nothing of it.
  void discard();
  // Drains what is left and hands over everything.
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
