#pragma once
#include <array>
#include <cstdint>
#include <optional>
namespace tapstudy::device {
using Nanoseconds = std::int64_t;

// The loop's time source.
class TickClock {
 public:
  virtual ~TickClock() = default;
  virtual Nanoseconds now() noexcept = 0;
  // Returns the wake-up time, which is never before the deadline.
  virtual Nanoseconds wait_until(Nanoseconds deadline) noexcept = 0;
  // For how long the machine has been suspended since it was started; now() stands still meanwhile.
  virtual Nanoseconds suspended() noexcept { return 0; }
};

// Real time: CLOCK_MONOTONIC with absolute deadlines, so that lateness does not accumulate.
class MonotonicClock final : public TickClock {
 public:
  Nanoseconds now() noexcept override;
  Nanoseconds wait_until(Nanoseconds deadline) noexcept override;
  Nanoseconds suspended() noexcept override;
};

// Time that passes as fast as the loop computes.
class VirtualClock final : public TickClock {
 public:
  Nanoseconds now() noexcept override { return now_; }
  Nanoseconds wait_until(Nanoseconds deadline) noexcept override { return now_ = deadline; }

 private:
  Nanoseconds now_{0};
};

// Histogram of tick lateness with 36 bins per octave: any quantile is known to within 2 %, without
// storing each tick.
class LatenessCount {
 public:
  void add(Nanoseconds lateness) noexcept;
  void add(const LatenessCount& other) noexcept;
  std::int64_t count() const noexcept { return count_; }
  Nanoseconds worst() const noexcept { return worst_; }
  // Upper edge of the bin at or below which at least this fraction of the ticks lie, 0 to 1.
  Nanoseconds quantile(double share) const noexcept;
  // Where the quantile of all ticks lies, of which these are a sample, with 95 %: between two of
  // the sample's own.
  struct Interval {
    Nanoseconds low{};
    std::optional<Nanoseconds> high;  // unset: so few ticks do not tell
  };
  Interval interval_of_quantile(double share) const noexcept;

 private:
  // From the earliest, 1.
  Nanoseconds of_rank(std::int64_t rank) const noexcept;

  static constexpr std::size_t per_octave = 36;
  static constexpr std::size_t classes = 40 * per_octave;  // to 2^40 ns
  std::array<std::int64_t, classes> in_class_{};
  std::int64_t count_{0};
  Nanoseconds worst_{0};
};
}  // namespace tapstudy::device
