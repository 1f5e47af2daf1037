#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "core/haptic_state.hpp"
#include "results/rows.hpp"
namespace tapstudy::results {
// The events of one trial, extracted from its ticks in order: contacts, impacts, releases,
// switches. Where a late tick came up to 5 ms before an impact, the hand's speed was averaged over
// a longer time: the impact is noted once more as late_impact. A tick with a fault yields no event.
class TraceEvents {
 public:
  // In SQL, with what is noted where no tick was kept: a trial's other events do not follow from
  // its ticks.
  static constexpr std::string_view kinds =
      "('switch', 'contact', 'impact', 'late_impact', 'release', 'untraced')";

  void add(const core::TraceSample& sample, std::vector<EventRow>& events);

 private:
  core::TraceSample previous_{};
  std::optional<std::int64_t> last_late_ns_;
  bool has_previous_{false};
};
std::optional<double> first_contact_s(const std::vector<EventRow>& events);
// Time of a tick from the first one of its trial.
double time_s(const core::TraceSample& sample);
}  // namespace tapstudy::results
