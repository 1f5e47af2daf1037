#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "core/tick/actuator_tape.hpp"
#include "core/tick/spsc_ring.hpp"
#include "results/rows.hpp"
#include "results/traces/trace_codec.hpp"
namespace tapstudy::results {
// The events of one trial, extracted from its ticks in order: contacts, impacts, releases,
// switches. Where a late tick came up to 5 ms before an impact, the hand's speed was averaged over
// a longer time: the impact is noted once more as late_impact. A tick with a fault yields no event.
class TraceEvents {
 public:
  // These kinds as an SQL list, with the event of an untraced trial; a trial's other events do not
  // follow from its ticks.
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

enum class Traced { whole, events_only };

// Collects one trial's periods of an actuator's card, in chunks, with times from the trial's first
// tick.
class ActuatorCollector {
 public:
  // began_at: when the first tick was made, by the loop's clock; unset before.
  using BeganAt = std::function<std::optional<std::int64_t>()>;
  ActuatorCollector(core::ActuatorTape& tape, BeganAt began_at)
      : tape_{&tape}, began_at_{std::move(began_at)} {}
  void drain();
  std::vector<ActuatorChunk> finish();

 private:
  void pack(std::int64_t began_at_ns);

  core::ActuatorTape* tape_;
  BeganAt began_at_;
  ActuatorTrace pending_;
  std::int64_t packed_{0};  // periods
  std::vector<ActuatorChunk> chunks_;
};

// Collects one trial's samples from the haptic thread's ring for the store: encodes them in chunks
// as they arrive and extracts the events (TraceEvents). Without chunks the first event is
// `untraced`.
class TraceCollector {
 public:
  explicit TraceCollector(core::SpscRing<core::TraceSample>& ring, Traced traced = Traced::whole)
      : ring_{&ring}, traced_{traced} {}
  // Called with each sample as it is drained, by whoever drains.
  using Watch = std::function<void(const core::TraceSample&)>;
  void watch(Watch watch) { watch_ = std::move(watch); }
  // Collects what an actuator is given, too; not where only events are kept.
  void add(core::ActuatorTape& tape, ActuatorCollector::BeganAt began_at);
  void drain();
  // Empties the ring and discards its contents.
  void discard();
  // Drains the remaining samples and returns everything.
  struct Collected {
    std::vector<TraceChunk> chunks;
    std::vector<ActuatorChunk> actuator;
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
  std::optional<ActuatorCollector> actuator_;
  std::vector<core::TraceSample> pending_;
  Collected collected_;
  TraceEvents events_;
};
}  // namespace tapstudy::results
