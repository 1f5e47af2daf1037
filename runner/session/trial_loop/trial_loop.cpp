#include "runner/session/trial_loop/trial_loop.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::runner {
std::optional<device::ScriptedHand> scripted_hand(const Rendered& rendered,
                                                  const device::LoopSettings& settings) {
  if (!rendered.scripted) {
    return std::nullopt;
  }
  return device::ScriptedHand{*rendered.scripted, settings.placement,
                              1e-9 * static_cast<double>(settings.period)};
}

namespace {
constexpr std::size_t slice_ticks = 1024;

class VirtualExploration final : public LoopExploration {
 public:
  VirtualExploration(device::HapticLoop& loop, results::TraceCollector& collector, double period_s,
                     Keep keep)
      : LoopExploration{loop}, collector_{collector}, period_s_{period_s}, keep_{keep} {}
  void pass_time(double seconds) override {
    auto left = static_cast<std::int64_t>(std::llround(seconds / period_s_));
    while (left > 0 && is_running()) {
      const std::int64_t slice = std::min<std::int64_t>(left, slice_ticks);
      loop().run_ticks(slice);
      keep_ == Keep::nothing ? collector_.discard() : collector_.drain();
      left -= slice;
    }
  }
  bool is_running() const override { return loop().report().stopped_by == core::TickFault::none; }
  bool is_rendering() const override { return is_running(); }
  double time_s() const override { return static_cast<double>(loop().report().ticks) * period_s_; }

 private:
  results::TraceCollector& collector_;
  double period_s_;
  Keep keep_;
};
}  // namespace

TrialResult VirtualTrialLoop::run(const Rendered& rendered, const Explore& explore) {
  core::SpscRing<core::TraceSample> ring{slice_ticks};
  results::TraceCollector collector{
      ring, keep_ == Keep::events ? results::Traced::events_only : results::Traced::whole};
  device::VirtualClock clock;
  std::optional<device::ScriptedHand> taps = scripted_hand(rendered, settings_);
  device::HapticLoop loop{device_, rendered.alternatives,  settings_, ring,
                          clock,   taps ? &*taps : nullptr};
  VirtualExploration exploration{loop, collector, 1e-9 * static_cast<double>(settings_.period),
                                 keep_};
  explore(exploration);
  loop.zero_force();
  return {collector.finish(), loop.report(), static_cast<std::int64_t>(ring.dropped())};
}
}  // namespace tapstudy::runner
