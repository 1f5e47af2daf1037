#include "runner/markers/markers.hpp"

#include <fmt/format.h>

#include "runner/markers/line_markers.hpp"
#include "runner/markers/osc_markers.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
Markers::Markers(const protocols::MarkerSettings& settings) {
  if (settings.osc) {
    outputs_.push_back({open_osc_markers(*settings.osc)});
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

void Markers::send(const results::SessionEventRow& change) {
  const std::lock_guard lock{mutex_};
  for (Counted& counted : outputs_) {
    if (counted.output->send(change) == Sent::no && counted.lost++ == 0) {
      warn(fmt::format("markers, {}: '{}' could not be delivered; the session continues",
                       counted.output->name(), change.state));
    }
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
}  // namespace tapstudy::runner
