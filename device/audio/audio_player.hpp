#pragma once
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/settings/device_settings.hpp"
#include "device/audio/pcm.hpp"
namespace tapstudy::device {
enum class Heard { yes, no };

// A gain that goes from 0 to 1 and back along half a period of a cosine, without a step or a kink;
// turned round on its way it goes back from where it is.
class Ramp {
 public:
  Ramp(double duration_s, double rate_hz) : frames_{std::lround(duration_s * rate_hz)} {}
  void apply(std::span<float> samples, Heard wanted) noexcept;
  void restart() noexcept { way_frames_ = 0; }
  bool is_silent() const noexcept { return way_frames_ == 0; }

 private:
  long frames_;
  long way_frames_{0};  // 0: silent, frames_: full
};

// What became of the samples since the latest fade_in().
struct Played : PlayedPeriods {
  std::int64_t cut{};  // samples beyond full scale
};

// Plays a source through a sink on a thread of its own, faded in and out. Neither call waits for
// the card. After an underrun it plays on; a card that has gone, or takes nothing for a second, is
// lost for good.
class AudioPlayer {
 public:
  AudioPlayer(std::unique_ptr<PcmSink> sink, std::unique_ptr<SampleSource> source, double ramp_s,
              const core::RealtimeRequest& realtime);
  // Fades out.
  ~AudioPlayer();
  AudioPlayer(const AudioPlayer&) = delete;
  AudioPlayer& operator=(const AudioPlayer&) = delete;
  AudioPlayer(AudioPlayer&&) = delete;
  AudioPlayer& operator=(AudioPlayer&&) = delete;

  // Returns after the ramp, or as soon as the card is lost.
  void fade_in();
  // Returns at once; the ramp goes on.
  void fade_out();
  Played played() const;
  bool is_playing() const;  // or fading in

 private:
  void run();
  bool is_asked_to_play();
  void play();
  Heard wanted() const;
  // Whether the card is still there.
  bool note(PcmOutcome outcome, std::int64_t cut);

  std::unique_ptr<PcmSink> sink_;
  std::unique_ptr<SampleSource> source_;
  std::chrono::duration<double> ramp_time_;
  core::RealtimeRequest realtime_;
  Ramp ramp_;  // the thread's, like the period
  std::vector<float> period_;
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  Heard wanted_{Heard::no};
  bool is_ending_{false};
  Played played_;
  std::thread thread_;
};
}  // namespace tapstudy::device
