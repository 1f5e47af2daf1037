#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "protocols/rig.hpp"
#include "results/rows.hpp"
#include "results/traces/trace_collector.hpp"
#include "runner/session/markers/marker_output.hpp"
namespace tapstudy::runner {
// begun: from when the times of changes count.
Marker marker_of(const results::SessionEventRow& change,
                 std::chrono::steady_clock::time_point begun);

// All that a rig asks to be told of what the session does, from any thread. What is lost is
// counted; of each output that loses markers the operator is warned once, and told at the end how
// many they were.
class Markers {
 public:
  // Throws InvalidInput or DeviceError if one cannot be opened.
  explicit Markers(const protocols::MarkerSettings& settings);
  ~Markers();
  Markers(const Markers&) = delete;
  Markers& operator=(const Markers&) = delete;
  Markers(Markers&&) = delete;
  Markers& operator=(Markers&&) = delete;
  void send(const Marker& marker);
  void send_force(const ForceSample& sample);
  std::int64_t lost() const;

 private:
  struct Counted {
    std::unique_ptr<MarkerOutput> output;
    std::int64_t lost{0};
  };
  mutable std::mutex mutex_;
  std::vector<Counted> outputs_;
};

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
