#include "runner/session/markers/markers.hpp"

#include <fmt/format.h>

#include "runner/session/markers/marker_output.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
Marker marker_of(const results::SessionEventRow& change,
                 std::chrono::steady_clock::time_point begun) {
  using std::chrono::nanoseconds;
  const auto at =
      begun + std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>{change.t_s});
  const nanoseconds age = std::chrono::steady_clock::now() - at;
  const auto utc = std::chrono::system_clock::now() - age;
  return {change, nanoseconds{at.time_since_epoch()}.count(),
          nanoseconds{utc.time_since_epoch()}.count()};
}

Markers::Markers(const protocols::MarkerSettings& settings) {
  if (settings.osc) {
    outputs_.push_back({open_osc_markers(*settings.osc)});
  }
  if (settings.lsl) {
    outputs_.push_back({open_lsl_markers(*settings.lsl)});
  }
  if (!settings.lines.empty()) {
    outputs_.push_back({open_line_markers(settings.lines)});
  }
}

Markers::~Markers() {
  for (const Counted& counted : outputs_) {
    if (counted.lost > 0) {
      warn(fmt::format("markers, {}: {} were lost", counted.output->name(), counted.lost));
    }
  }
}

void Markers::send(const Marker& marker) {
  const std::lock_guard lock{mutex_};
  for (Counted& counted : outputs_) {
    if (counted.output->send(marker) == Sent::no && counted.lost++ == 0) {
      warn(fmt::format("markers, {}: '{}' could not be delivered; the session continues",
                       counted.output->name(), marker.change.state));
    }
  }
}

void Markers::send_force(const ForceSample& sample) {
  const std::lock_guard lock{mutex_};
  for (Counted& counted : outputs_) {
    counted.output->send_force(sample);
  }
}

std::int64_t Markers::lost() const {
  const std::lock_guard lock{mutex_};
  std::int64_t lost = 0;
  for (const Counted& counted : outputs_) {
    lost += counted.lost;
  }
  return lost;
}

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
