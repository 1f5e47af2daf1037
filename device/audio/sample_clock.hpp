#pragma once
#include <cstdint>
#include <optional>
namespace tapstudy::device {
// When the samples of a card are heard, by the clock of the haptic loop: a delay-locked loop over
// the times measured once a period, which wander with the scheduler (Adriaensen 2005, Using a DLL
// to filter time, Linux Audio Conference). With T the length of a period as estimated so far, t the
// time predicted for the next one and e the measured time less t,
//     t' = t + b e + T,   T' = T + c e,   b = √2 w, c = w², w = 2 pi B T0,
// B the bandwidth and T0 the nominal length. Cards that tell what they have played in whole periods
// are off by one at most; a period that is off by more than two has not been played on, and the
// loop starts anew, as after a gap that the card reports.
class SampleClock {
 public:
  SampleClock(double rate_hz, double period_frames) noexcept;
  // The first frame of the next period is heard at this time.
  void measured(double heard_at_ns) noexcept;
  // There was a gap.
  void restart() noexcept { periods_ = 0; }
  // Of the latest period that was measured: its first frame, and the time from one to the next.
  double first_frame_ns() const noexcept { return begins_ns_; }
  double frame_ns() const noexcept { return period_ns_ / frames_; }
  // The card's rate against this clock, less 1.
  double rate_error() const noexcept { return nominal_ns_ / period_ns_ - 1.0; }
  // Root of the mean square of e, the first second after each gap left out; unset: there is no
  // more.
  std::optional<double> jitter_s() const noexcept;

 private:
  double frames_;
  double nominal_ns_;
  double b_;
  double c_;
  double begins_ns_{0.0};
  double next_ns_{0.0};
  double period_ns_;
  std::int64_t periods_{0};  // since the start
  double squares_ns2_{0.0};
  std::int64_t counted_{0};
};
}  // namespace tapstudy::device
