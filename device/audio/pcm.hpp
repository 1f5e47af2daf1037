#pragma once
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

// So many periods for which there was no room, each for 100 ms: the card takes nothing any more.
inline constexpr int max_lost_in_a_row = 10;

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

// What is played into the ears.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  // The next samples; full scale is from -1 to 1. On the audio thread: must not wait.
  virtual void fill(std::span<float> samples) noexcept = 0;
};
}  // namespace tapstudy::device
