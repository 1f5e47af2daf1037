#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "core/haptic_state.hpp"
#include "core/tick/spsc_ring.hpp"
#include "results/rows.hpp"
#include "results/trace_events.hpp"
namespace tapstudy::results {
enum class Traced { whole, events_only };

// Collects one trial's samples from the haptic thread's ring for the store: encodes them in chunks
// as they arrive and extracts the events (trace_events.hpp). Without chunks the first event is
// `untraced`.
class TraceCollector {
 public:
  explicit TraceCollector(core::SpscRing<core::TraceSample>& ring, Traced traced = Traced::whole)
      : ring_{&ring}, traced_{traced} {}
  // Called with each sample as it is drained, by whoever drains.
  using Watch = std::function<void(const core::TraceSample&)>;
  void watch(Watch watch) { watch_ = std::move(watch); }
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
  void pack();

  core::SpscRing<core::TraceSample>* ring_;
  Traced traced_;
  Watch watch_;
  std::vector<core::TraceSample> pending_;
  Collected collected_;
  TraceEvents events_;
};
}  // namespace tapstudy::results
