#include "device/audio/card_probe.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "device/audio/actuator_player.hpp"
#include "device/audio/pace.hpp"
#include "device/audio/sample_clock.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
Nanoseconds ProbedCard::bridged() const {
  return std::llround(1e9 * (buffer_s - period_s));
}

ProbedCard probe_card(PcmSink& sink, double seconds, const CardTime& time) {
  const double rate_hz = sink.rate_hz();
  const auto frames_to_ns = [&](double frames) { return 1e9 * frames / rate_hz; };
  const auto buffer = static_cast<long>(sink.buffer_frames());
  const std::vector<float> silence(sink.period_frames());
  const auto period = static_cast<long>(silence.size());
  ProbedCard probed{.rate_hz = rate_hz,
                    .period_s = static_cast<double>(period) / rate_hz,
                    .buffer_s = static_cast<double>(buffer) / rate_hz,
                    .delay_s = actuator_delay_s(sink)};
  SampleClock clock{rate_hz, static_cast<double>(period)};
  PlayedPeriods played;
  long to_fill = buffer;
  sink.begin();
  for (auto left = std::llround(seconds * rate_hz / static_cast<double>(period));
       left > 0 && !played.loss; --left) {
    clock.measured(static_cast<double>(time.now_ns()) +
                   frames_to_ns(static_cast<double>(sink.delay_frames().value_or(0))));
    const PcmOutcome outcome = sink.write(silence);
    played.note(outcome, sink);
    if (outcome == PcmOutcome::played) {
      to_fill = std::max(0L, to_fill - period);
    } else {
      to_fill = buffer - period;
      clock.restart();
    }
    // a card that tells of no sample just after it was given a period tells nothing
    if (const long filled = sink.delay_frames().value_or(0); filled > 0 && to_fill == 0) {
      probed.lateness.add(
          std::llround(frames_to_ns(static_cast<double>(std::max(0L, buffer - filled)))));
    }
    time.wait_after(silence.size());
  }
  sink.end();
  probed.gaps = played.underruns;
  probed.loss = played.loss;
  probed.rate_error = clock.rate_error();
  probed.jitter_s = clock.jitter_s();
  return probed;
}

ProbedCard probe_card(PcmSink& sink, double seconds, const core::RealtimeRequest& request) {
  ProbedCard probed;
  std::thread{[&] {
    ask_for_realtime(request);
    Pace pace{sink, fastest_card};
    MonotonicClock clock;
    probed = probe_card(
        sink, seconds,
        {[&] { return clock.now(); }, [&](std::size_t frames) { pace.wait_after(frames); }});
  }}.join();
  return probed;
}
}  // namespace tapstudy::device
