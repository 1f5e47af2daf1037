#include "runner/markers/tap_markers.hpp"

#include <fmt/format.h>
namespace tapstudy::runner {
void TapMarkers::add(const core::TraceSample& sample, double at_s, int trial) {
  if (sample.t_ns < last_t_ns_) {  // another trial
    found_ = {};
  }
  last_t_ns_ = sample.t_ns;
  events_.clear();
  found_.add(sample, events_);
  for (const results::EventRow& event : events_) {
    send_({session_id_, at_s, event.kind, trial, fmt::format("{:.6g}", event.value)});
  }
}
}  // namespace tapstudy::runner
