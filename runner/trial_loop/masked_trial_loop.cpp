#include "runner/trial_loop/masked_trial_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "device/device.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
using Clock = std::chrono::steady_clock;

// RAII: heard during this object's lifetime.
class Audible {
 public:
  explicit Audible(device::AudioPlayer& player) : player_{player} { player_.fade_in(); }
  ~Audible() { player_.fade_out(); }
  Audible(const Audible&) = delete;
  Audible& operator=(const Audible&) = delete;
  Audible(Audible&&) = delete;
  Audible& operator=(Audible&&) = delete;

 private:
  device::AudioPlayer& player_;
};

void add_events(const device::Played& played, double level_db_fs, Clock::time_point begun,
                std::vector<results::EventRow>& events) {
  const auto since_begin_s = [&](Clock::time_point time) {
    return std::max(0.0, std::chrono::duration<double>(time - begun).count());
  };
  events.insert(events.begin(), {0.0, "masking", level_db_fs});
  if (played.underruns > 0) {
    events.push_back({0.0, "masking_underrun", static_cast<double>(played.underruns)});
  }
  if (played.cut > 0) {
    events.push_back({0.0, "masking_cut", static_cast<double>(played.cut)});
  }
  if (played.loss) {
    events.push_back({since_begin_s(played.loss->at), "masking_lost", 0.0});
  }
}
}  // namespace

void MaskedTrialLoop::tell(bool is_heard, std::string_view state, const std::string& detail) const {
  if (is_heard && noise_.tell) {
    noise_.tell(state, detail);
  }
}

TrialResult MaskedTrialLoop::run(const Rendered& rendered, const Explore& explore) {
  if (const auto& loss = player_.played().loss; noise_.is_required && loss) {
    throw device::DeviceError{fmt::format(
        "masking noise is no longer played ({}), and the protocol requires it", loss->why)};
  }
  TrialResult result;
  device::Played played;
  bool has_begun = false;
  Clock::time_point begun;
  {
    const Audible audible{player_};
    has_begun = !player_.played().loss;
    tell(has_begun, "masking", fmt::format("{:.1f} dB FS", noise_.level_db_fs));
    begun = Clock::now();
    result = inner_.run(rendered, explore);
    played = player_.played();
    tell(has_begun, "masking_end", "");
  }
  if (has_begun) {
    add_events(played, noise_.level_db_fs, begun, result.trace.events);
  }
  if (played.loss && !has_warned_) {
    has_warned_ = true;
    warn(fmt::format("masking noise is no longer played ({}); {}", played.loss->why,
                     noise_.is_required ? "the session ends, since the protocol requires it"
                                        : "the session goes on without it"));
  }
  return result;
}
}  // namespace tapstudy::runner
