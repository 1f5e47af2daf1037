#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
namespace tapstudy::device {
// What became of a period of samples.
//   played    it is in the card's buffer
//   underrun  likewise, but the buffer had run empty before: there was a gap
//   lost      the card had no room for it in time
//   gone      the card plays no more; failure() tells why
enum class PcmOutcome : std::uint8_t { played, underrun, lost, gone };

// Plays samples in periods. What keeps a card busy, and what it does with one channel of samples,
// is its own affair.
class PcmSink {
 public:
  virtual ~PcmSink() = default;
  virtual double rate_hz() const = 0;
  virtual std::size_t period_frames() const = 0;
  virtual std::size_t buffer_frames() const = 0;
  virtual void begin() noexcept = 0;
  // Waits for room, but no longer than 100 ms.
  virtual PcmOutcome write(std::span<const float> period) noexcept = 0;
  // Silent at once: what is in the buffer is discarded.
  virtual void end() noexcept = 0;
  // How many frames are heard before the next one that is written; nullopt: the card does not tell.
  virtual std::optional<long> delay_frames() noexcept { return std::nullopt; }
  virtual std::string failure() const = 0;
};

// A card that plays no more.
struct AudioLoss {
  std::string why;
  std::chrono::steady_clock::time_point at;
};

// What became of a card's periods.
struct PlayedPeriods {
  std::int64_t underruns{};  // gaps, and periods that the card had no room for in time
  std::optional<AudioLoss> loss{};
  int lost_in_a_row{};

  // A card that has had no room for ten periods, 100 ms each, is lost, too.
  void note(PcmOutcome outcome, const PcmSink& sink) {
    constexpr int max_lost_in_a_row = 10;
    underruns += outcome == PcmOutcome::underrun || outcome == PcmOutcome::lost ? 1 : 0;
    lost_in_a_row = outcome == PcmOutcome::lost ? lost_in_a_row + 1 : 0;
    const bool takes_nothing = lost_in_a_row >= max_lost_in_a_row;
    if (outcome == PcmOutcome::gone || takes_nothing) {
      loss = AudioLoss{takes_nothing ? "the card takes no samples" : sink.failure(),
                       std::chrono::steady_clock::now()};
    }
  }
};

// What is played into the ears.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  // The next samples; full scale is from -1 to 1. On the audio thread: must not wait.
  virtual void fill(std::span<float> samples) noexcept = 0;
};
}  // namespace tapstudy::device
