#include "runner/trial_loop/virtual_trial_loop.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::runner {
namespace {
constexpr std::size_t slice_ticks = 1024;

class VirtualExploration final : public Exploration {
 public:
  VirtualExploration(device::HapticLoop& loop, results::TraceCollector& collector, double period_s,
                     Keep keep)
      : loop_{loop}, collector_{collector}, period_s_{period_s}, keep_{keep} {}
  void switch_to(std::size_t alternative) override {
    current_ = alternative;
    loop_.request_alternative(alternative);
  }
  std::size_t current() const override { return current_; }
  void silence(bool is_silent) override { loop_.request_silence(is_silent); }
  bool is_as_asked() const override { return loop_.is_as_requested(); }
  void pass_time(double seconds) override {
    auto left = static_cast<std::int64_t>(std::llround(seconds / period_s_));
    while (left > 0 && is_running()) {
      const std::int64_t slice = std::min<std::int64_t>(left, slice_ticks);
      loop_.run_ticks(slice);
      keep_ == Keep::nothing ? collector_.discard() : collector_.drain();
      left -= slice;
    }
  }
  bool is_running() const override { return loop_.report().stopped_by == core::TickFault::none; }
  double time_s() const override { return static_cast<double>(loop_.report().ticks) * period_s_; }

  int contacts(std::size_t alternative) const override { return loop_.contacts(alternative); }

 private:
  device::HapticLoop& loop_;
  results::TraceCollector& collector_;
  double period_s_;
  Keep keep_;
  std::size_t current_{0};
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
