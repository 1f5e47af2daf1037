#include "results/trace_collector.hpp"

#include <utility>

#include "core/placement.hpp"
#include "results/trace_codec.hpp"
namespace tapstudy::results {
namespace {
constexpr std::size_t ticks_per_chunk = 4096;
constexpr std::int64_t late_impact_ns = 5'000'000;
}  // namespace

void TraceCollector::drain() {
  core::TraceSample sample{};
  while (ring_->try_pop(sample)) {
    note_events(sample);
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

// A tick with a fault yields no contact and no release events.
void TraceCollector::note_events(const core::TraceSample& sample) {
  collected_.duration_s = 1e-9 * static_cast<double>(sample.t_ns);
  if (sample.fault != core::TickFault::none) {
    return;
  }
  const double t_s = 1e-9 * static_cast<double>(sample.t_ns);
  const auto note = [&](const char* kind, double value) {
    collected_.events.push_back({t_s, kind, value});
  };
  if (!has_previous_ || sample.alternative != previous_.alternative) {
    note("switch", sample.alternative);
  }
  if (sample.touching && !previous_.touching) {
    note("contact", 0.0);
  }
  if (sample.late) {
    last_late_ns_ = sample.t_ns;
  }
  if (sample.impact) {
    const double speed_m_s = -core::along_normal(sample.velocity_m_s);
    note("impact", speed_m_s);
    if (last_late_ns_ && sample.t_ns - *last_late_ns_ <= late_impact_ns) {
      note("late_impact", speed_m_s);
    }
  }
  if (!sample.touching && previous_.touching) {
    note("release", 0.0);
  }
  previous_ = sample;
  has_previous_ = true;
}

void TraceCollector::pack() {
  if (pending_.empty()) {
    return;
  }
  const auto ticks = static_cast<std::int64_t>(pending_.size());
  collected_.chunks.push_back({collected_.ticks, ticks, encode_trace(pending_)});
  collected_.ticks += ticks;
  pending_.clear();
}

TraceCollector::Collected TraceCollector::finish() {
  drain();
  pack();
  has_previous_ = false;
  previous_ = {};
  last_late_ns_.reset();
  return std::exchange(collected_, {});
}
}  // namespace tapstudy::results
