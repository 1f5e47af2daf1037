#include "device/audio/alsa_sink.hpp"

#include <alsa/asoundlib.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr std::chrono::milliseconds max_wait{100};

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

struct Free {
  void operator()(snd_pcm_hw_params_t* parameters) const { snd_pcm_hw_params_free(parameters); }
  void operator()(snd_pcm_sw_params_t* parameters) const { snd_pcm_sw_params_free(parameters); }
};

struct Format {
  snd_pcm_format_t format;
  std::size_t bytes;
};
constexpr Format wide{SND_PCM_FORMAT_S32, 4};
constexpr Format narrow{SND_PCM_FORMAT_S16, 2};

class AlsaSink final : public PcmSink {
 public:
  explicit AlsaSink(const AlsaSettings& settings)
      : card_{settings.card}, channels_{static_cast<unsigned>(settings.channels)} {
    snd_lib_error_set_handler(say_nothing);  // what it would print is thrown
    check("cannot be opened",
          snd_pcm_open(&pcm_, card_.c_str(), SND_PCM_STREAM_PLAYBACK, SND_PCM_NONBLOCK));
    try {
      set_up(settings);
    } catch (...) {
      snd_pcm_close(pcm_);
      throw;
    }
    bytes_.resize(period_frames_ * channels_ * format_.bytes);
    played_on_.assign(channels_, !settings.only_channel);
    if (settings.only_channel) {
      played_on_[static_cast<std::size_t>(*settings.only_channel)] = true;
    }
  }
  ~AlsaSink() override { snd_pcm_close(pcm_); }
  AlsaSink(const AlsaSink&) = delete;
  AlsaSink& operator=(const AlsaSink&) = delete;
  AlsaSink(AlsaSink&&) = delete;
  AlsaSink& operator=(AlsaSink&&) = delete;

  double rate_hz() const override { return rate_hz_; }
  std::size_t period_frames() const override { return period_frames_; }
  std::size_t buffer_frames() const override { return buffer_frames_; }
  std::string failure() const override { return snd_strerror(failure_); }
  std::optional<long> delay_frames() noexcept override {
    snd_pcm_sframes_t frames = 0;
    return snd_pcm_delay(pcm_, &frames) == 0 ? std::optional<long>{frames} : std::nullopt;
  }

  void begin() noexcept override { snd_pcm_prepare(pcm_); }
  void end() noexcept override { snd_pcm_drop(pcm_); }

  PcmOutcome write(std::span<const float> period) noexcept override {
    encode(period);
    const auto until = std::chrono::steady_clock::now() + max_wait;
    PcmOutcome outcome = PcmOutcome::played;
    std::size_t written = 0;
    while (written < period.size()) {
      const int result = write_more(period.size(), written);
      if (result < 0 && !goes_on_after(result)) {
        return PcmOutcome::gone;
      }
      if (result < 0) {
        outcome = PcmOutcome::underrun;
      }
      if (std::chrono::steady_clock::now() > until && written < period.size()) {
        return PcmOutcome::lost;
      }
    }
    return outcome;
  }

 private:
  // What the card takes now, or waits for room. Negative: an error of the library.
  int write_more(std::size_t frames, std::size_t& written) noexcept {
    const snd_pcm_sframes_t taken =
        snd_pcm_writei(pcm_, bytes_.data() + written * channels_ * format_.bytes, frames - written);
    if (taken == 0 || taken == -EAGAIN) {
      return snd_pcm_wait(pcm_, static_cast<int>(max_wait.count()));
    }
    written += static_cast<std::size_t>(std::max<snd_pcm_sframes_t>(taken, 0));
    return static_cast<int>(std::min<snd_pcm_sframes_t>(taken, 0));
  }

  void check(const std::string& what, int error) const {
    if (error < 0) {
      throw DeviceError{fmt::format("audio: card '{}' {}: {}", card_, what, snd_strerror(error))};
    }
  }

  void set_up(const AlsaSettings& settings) {
    snd_pcm_hw_params_t* allocated = nullptr;
    check("cannot be set up", snd_pcm_hw_params_malloc(&allocated));
    const std::unique_ptr<snd_pcm_hw_params_t, Free> owned{allocated};
    snd_pcm_hw_params_t* const hw = owned.get();
    check("cannot be set up", snd_pcm_hw_params_any(pcm_, hw));
    check("takes no interleaved samples",
          snd_pcm_hw_params_set_access(pcm_, hw, SND_PCM_ACCESS_RW_INTERLEAVED));
    format_ = snd_pcm_hw_params_test_format(pcm_, hw, wide.format) == 0 ? wide : narrow;
    check("takes neither 32 nor 16 bits", snd_pcm_hw_params_set_format(pcm_, hw, format_.format));
    check("has no channels", snd_pcm_hw_params_set_channels_near(pcm_, hw, &channels_));
    if (settings.only_channel && *settings.only_channel >= static_cast<int>(channels_)) {
      throw DeviceError{fmt::format("audio: card '{}' has {} channels, none of them number {}",
                                    card_, channels_, *settings.only_channel + 1)};
    }
    rate_hz_ = static_cast<unsigned>(settings.rate_hz);
    check(fmt::format("does not play {} Hz", rate_hz_),
          snd_pcm_hw_params_set_rate(pcm_, hw, rate_hz_, 0));
    period_frames_ = static_cast<snd_pcm_uframes_t>(std::llround(settings.period_s * rate_hz_));
    buffer_frames_ = period_frames_ * static_cast<snd_pcm_uframes_t>(settings.periods);
    check("has no such period",
          snd_pcm_hw_params_set_period_size_near(pcm_, hw, &period_frames_, nullptr));
    check("has no such buffer", snd_pcm_hw_params_set_buffer_size_near(pcm_, hw, &buffer_frames_));
    check("refuses its settings", snd_pcm_hw_params(pcm_, hw));
    start_with_full_buffer();
  }
  void start_with_full_buffer() {
    snd_pcm_sw_params_t* allocated = nullptr;
    check("cannot be set up", snd_pcm_sw_params_malloc(&allocated));
    const std::unique_ptr<snd_pcm_sw_params_t, Free> sw{allocated};
    check("cannot be set up", snd_pcm_sw_params_current(pcm_, sw.get()));
    check("refuses to start with a full buffer",
          snd_pcm_sw_params_set_start_threshold(pcm_, sw.get(), buffer_frames_));
    check("refuses its settings", snd_pcm_sw_params(pcm_, sw.get()));
  }

  void encode(std::span<const float> period) noexcept {
    format_.bytes == wide.bytes ? encode_as<std::int32_t>(period) : encode_as<std::int16_t>(period);
  }
  template <class Integer>
  void encode_as(std::span<const float> period) noexcept {
    constexpr double full_scale = std::numeric_limits<Integer>::max();
    std::byte* to = bytes_.data();
    for (const float sample : period) {
      const auto value = static_cast<Integer>(std::lrint(full_scale * static_cast<double>(sample)));
      for (unsigned channel = 0; channel < channels_; ++channel, to += sizeof value) {
        const Integer played = played_on_[channel] ? value : Integer{0};
        std::memcpy(to, &played, sizeof played);
      }
    }
  }

  // Under-runs and a system that slept are overcome; a card that was pulled out is not.
  bool goes_on_after(int error) noexcept {
    const int again = error == -EPIPE || error == -ESTRPIPE ? snd_pcm_prepare(pcm_) : error;
    if (again < 0) {
      failure_ = again;
    }
    return again >= 0;
  }

  std::string card_;
  snd_pcm_t* pcm_{};
  Format format_{wide};
  unsigned channels_;
  std::vector<bool> played_on_;  // by channel
  unsigned rate_hz_{};
  snd_pcm_uframes_t period_frames_{};
  snd_pcm_uframes_t buffer_frames_{};
  std::vector<std::byte> bytes_;
  int failure_{0};
};
}  // namespace

std::unique_ptr<PcmSink> open_alsa(const AlsaSettings& settings) {
  return std::make_unique<AlsaSink>(settings);
}
}  // namespace tapstudy::device
