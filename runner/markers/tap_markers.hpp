#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "core/haptic_state.hpp"
#include "results/rows.hpp"
#include "results/trace_events.hpp"
namespace tapstudy::runner {
// What the ticks of live trials say of the taps, as markers: contacts, impacts, releases, switches,
// as results::TraceEvents finds them.
class TapMarkers {
 public:
  using Send = std::function<void(const results::SessionEventRow& marker)>;
  TapMarkers(std::int64_t session_id, Send send)
      : session_id_{session_id}, send_{std::move(send)} {}
  // One tick after the other. at_s: when it was made, from the session's begin.
  void add(const core::TraceSample& sample, double at_s, int trial);

 private:
  std::int64_t session_id_;
  Send send_;
  results::TraceEvents found_;
  std::vector<results::EventRow> events_;
  std::int64_t last_t_ns_{0};
};
}  // namespace tapstudy::runner
