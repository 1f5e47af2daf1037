#include "results/trace_events.hpp"

#include <algorithm>

#include "core/placement.hpp"
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
}  // namespace tapstudy::results
