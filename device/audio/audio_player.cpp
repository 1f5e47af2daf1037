#include "device/audio/audio_player.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "device/audio/pace.hpp"
#include "device/loop/realtime.hpp"
namespace tapstudy::device {
void Ramp::apply(std::span<float> samples, Heard wanted) noexcept {
  const long step = wanted == Heard::yes ? 1 : -1;
  for (float& sample : samples) {
    way_frames_ = std::clamp(way_frames_ + step, 0L, frames_);
    const double way = static_cast<double>(way_frames_) / static_cast<double>(frames_);
    sample *= static_cast<float>(0.5 - 0.5 * std::cos(std::numbers::pi * way));
  }
}

namespace {
// Cuts to full scale and tells how often; what is no number is silence.
std::int64_t cut_to_full_scale(std::span<float> samples) noexcept {
  std::int64_t cut = 0;
  for (float& sample : samples) {
    const float allowed = std::isfinite(sample) ? std::clamp(sample, -1.0F, 1.0F) : 0.0F;
    cut += allowed == sample ? 0 : 1;
    sample = allowed;
  }
  return cut;
}
}  // namespace

AudioPlayer::AudioPlayer(std::unique_ptr<PcmSink> sink, std::unique_ptr<SampleSource> source,
                         double ramp_s, const core::RealtimeRequest& realtime)
    : sink_{std::move(sink)},
      source_{std::move(source)},
      ramp_time_{ramp_s},
      realtime_{realtime},
      ramp_{ramp_s, sink_->rate_hz()},
      period_(sink_->period_frames()),
      thread_{[this] { run(); }} {}

AudioPlayer::~AudioPlayer() {
  {
    const std::lock_guard lock{mutex_};
    wanted_ = Heard::no;
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void AudioPlayer::fade_in() {
  std::unique_lock lock{mutex_};
  played_.underruns = 0;
  played_.cut = 0;
  wanted_ = Heard::yes;
  changed_.notify_all();
  changed_.wait_for(lock, ramp_time_, [this] { return played_.loss.has_value(); });
}

void AudioPlayer::fade_out() {
  const std::lock_guard lock{mutex_};
  wanted_ = Heard::no;
}

bool AudioPlayer::is_playing() const {
  const std::lock_guard lock{mutex_};
  return wanted_ == Heard::yes && !played_.loss;
}

Played AudioPlayer::played() const {
  const std::lock_guard lock{mutex_};
  return played_;
}

Heard AudioPlayer::wanted() const {
  const std::lock_guard lock{mutex_};
  return wanted_;
}

bool AudioPlayer::is_asked_to_play() {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [this] { return is_ending_ || (wanted_ == Heard::yes && !played_.loss); });
  return !is_ending_;
}

void AudioPlayer::run() {
  ask_for_realtime(realtime_);
  while (is_asked_to_play()) {
    sink_->begin();
    play();
    sink_->end();
  }
}

// Until it is faded out, all but silence has left the buffer, and a period of silence after it: a
// server of JACK repeats what a client played last until that has closed.
void AudioPlayer::play() {
  Pace pace{*sink_, 2.0};  // leaves a real card free to follow its own clock
  const std::size_t silence = sink_->buffer_frames() + period_.size();
  ramp_.restart();  // a card that failed at its end has cut the last fade short
  std::size_t silent_frames = 0;
  while (silent_frames <= silence) {
    const Heard is_wanted = wanted();
    source_->fill(period_);
    ramp_.apply(period_, is_wanted);
    const std::int64_t cut = cut_to_full_scale(period_);
    const PcmOutcome outcome = sink_->write(period_);
    const bool fails_at_its_end = is_wanted == Heard::no && outcome != PcmOutcome::played;
    if (!note(outcome, cut) || fails_at_its_end) {
      return;
    }
    silent_frames = ramp_.is_silent() ? silent_frames + period_.size() : 0;
    pace.wait_after(period_.size());
  }
}

bool AudioPlayer::note(PcmOutcome outcome, std::int64_t cut) {
  bool is_gone = false;
  {
    const std::lock_guard lock{mutex_};
    played_.cut += cut;
    played_.note(outcome, *sink_);
    is_gone = played_.loss.has_value();
  }
  if (is_gone) {
    changed_.notify_all();
  }
  return !is_gone;
}
}  // namespace tapstudy::device
