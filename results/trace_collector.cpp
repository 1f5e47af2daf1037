#include "results/trace_collector.hpp"

#include <utility>

#include "results/trace_codec.hpp"
namespace tapstudy::results {
namespace {
constexpr std::size_t ticks_per_chunk = 4096;
}  // namespace

void TraceCollector::drain() {
  core::TraceSample sample{};
  while (ring_->try_pop(sample)) {
    collected_.duration_s = time_s(sample);
    events_.add(sample, collected_.events);
    if (watch_) {
      watch_(sample);
    }
    pending_.push_back(sample);
    if (pending_.size() == ticks_per_chunk) {
      pack();
    }
  }
}

void TraceCollector::discard() {
  core::TraceSample sample{};
  while (ring_->try_pop(sample)) {
  }
}

void TraceCollector::pack() {
  if (pending_.empty()) {
    return;
  }
  const auto ticks = static_cast<std::int64_t>(pending_.size());
  if (traced_ == Traced::whole) {
    collected_.chunks.push_back({collected_.ticks, ticks, encode_trace(pending_)});
  }
  collected_.ticks += ticks;
  pending_.clear();
}

TraceCollector::Collected TraceCollector::finish() {
  drain();
  pack();
  events_ = {};
  if (traced_ == Traced::events_only) {
    collected_.events.insert(collected_.events.begin(), {0.0, untraced_event, 0.0});
  }
  return std::exchange(collected_, {});
}
}  // namespace tapstudy::results
