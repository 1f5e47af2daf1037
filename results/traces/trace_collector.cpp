#include "results/traces/trace_collector.hpp"

#include <algorithm>
#include <utility>

#include "core/haptics/haptic_state.hpp"
#include "results/traces/trace_codec.hpp"
namespace tapstudy::results {
namespace {
constexpr std::int64_t late_impact_ns = 5'000'000;
}  // namespace

double time_s(const core::TraceSample& sample) {
  return 1e-9 * static_cast<double>(sample.t_ns);
}

void TraceEvents::add(const core::TraceSample& sample, std::vector<EventRow>& events) {
  if (sample.fault != core::TickFault::none) {
    return;
  }
  const auto note = [&](const char* kind, double value) {
    events.push_back({time_s(sample), kind, value});
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

std::optional<double> first_contact_s(const std::vector<EventRow>& events) {
  const auto contact = std::ranges::find(events, "contact", &EventRow::kind);
  return contact == events.end() ? std::nullopt : std::optional{contact->t_s};
}

namespace {
constexpr std::size_t ticks_per_chunk = 4096;
constexpr std::size_t periods_per_chunk = 4096;
}  // namespace

void ActuatorCollector::drain() {
  core::ActuatorPeriod period{};
  while (tape_->pop(period, pending_.samples)) {
    pending_.periods.push_back(period);
    const std::optional<std::int64_t> began_at_ns = began_at_();
    if (pending_.periods.size() >= periods_per_chunk && began_at_ns) {
      pack(*began_at_ns);
    }
  }
}

void ActuatorCollector::pack(std::int64_t began_at_ns) {
  for (core::ActuatorPeriod& period : pending_.periods) {
    period.heard_at_ns -= began_at_ns;
    period.filled_at_ns -= began_at_ns;
  }
  const std::int64_t periods = std::ssize(pending_.periods);
  chunks_.push_back({packed_, periods, std::ssize(pending_.samples), encode_actuator(pending_)});
  packed_ += periods;
  pending_ = {};
}

std::vector<ActuatorChunk> ActuatorCollector::finish() {
  drain();
  if (const auto began_at_ns = began_at_(); began_at_ns && !pending_.periods.empty()) {
    pack(*began_at_ns);
  }
  return std::exchange(chunks_, {});
}

void TraceCollector::add(core::ActuatorTape& tape, ActuatorCollector::BeganAt began_at) {
  if (traced_ == Traced::whole) {
    actuator_.emplace(tape, std::move(began_at));
  }
}

void TraceCollector::drain() {
  if (actuator_) {
    actuator_->drain();
  }
  core::TraceSample sample{};
  while (ring_->try_pop(sample)) {
    collected_.duration_s = time_s(sample);
    events_.add(sample, collected_.events);
    if (watch_) {
      watch_(sample);
    }
    ++collected_.ticks;
    if (traced_ == Traced::whole) {
      pending_.push_back(sample);
    }
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
  collected_.chunks.push_back({collected_.ticks - ticks, ticks, encode_trace(pending_)});
  pending_.clear();
}

TraceCollector::Collected TraceCollector::finish() {
  drain();
  pack();
  events_ = {};
  if (actuator_) {
    std::vector<ActuatorChunk> chunks = actuator_->finish();
    if (collected_.ticks > 0) {
      collected_.actuator = std::move(chunks);
    }
  }
  if (traced_ == Traced::events_only) {
    collected_.events.insert(collected_.events.begin(), {0.0, untraced_event, 0.0});
  }
  return std::exchange(collected_, {});
}
}  // namespace tapstudy::results
