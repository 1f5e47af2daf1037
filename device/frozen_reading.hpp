#pragma once
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// Finds a device that goes on replying while its position stands still to the bit: its encoders
// have no supply, or the thread that reads them has died. A hand at rest, too, may leave every
// counter as it is for a while, so that only two things are a fault.
//
// Force has changed by 1 N or more since the position last did, for 50 ms. A hand gives: it is a
// spring of some 400 N/m, and of 4000 N/m at most where it clenches the grip, so that 1 N displaces
// it by 250 um at least. Its 0.1 to 0.5 kg reach that in 16 ms at most (½ a t², a = 2 m/s²), and
// its damping of 9 N s/m delays that by no more than b/k = 2 ms; 50 ms is three times as long. A
// SPIDAR's counter has steps of 17 um, so this is 15 of them along the force and 4 or more on a
// string whose direction has a cosine of 0.3 with it; other devices resolve 0.1 mm or better. Its
// strings alone would not do: of polyethylene (100 GPa), 0.4 mm thick and 0.1 m long, one gives
// 8 um per newton, half a step. A grip that is clamped to a bench may therefore be taken for
// frozen. A vibration is not such a change: at 200 Hz, 1 N moves 0.1 kg by 6 um. The time counts
// only while force stays 1 N away.
//
// Or 0.5 N or more have been exerted for 3 s. Whoever presses does so with a force that trembles by
// 1 % at 8 to 12 Hz: 5 mN by 400 N/m is 12 um rms, 35 um peak to peak, two steps on the string
// along it. A hand ten times stiller moves an eighth of a step in each cycle, and leaves eight
// counters, whose edges lie anywhere, as they are with (7/8)^8 = 0.34; but it also drifts, by 50
// um/s or more, so that each third of a second is a new draw: 0.34^9 = 7e-5 in 3 s.
//
// Without force nothing is concluded: a grip that nobody holds lies still.
class FrozenReading {
 public:
  void forget() noexcept { *this = {}; }
  // Once a reading, with the force commanded before it and the time since the reading before.
  [[nodiscard]] bool judge(bool is_same, const core::Vec3& force_n, double elapsed_s) noexcept {
    if (!is_same) {
      since_change_n_ = force_n;
      changed_s_ = held_s_ = 0.0;
      return false;
    }
    changed_s_ = (force_n - since_change_n_).squaredNorm() >= min_change_n * min_change_n
                     ? changed_s_ + elapsed_s
                     : 0.0;
    held_s_ = force_n.squaredNorm() >= min_force_n * min_force_n ? held_s_ + elapsed_s : 0.0;
    return changed_s_ > max_changed_s || held_s_ > max_held_s;
  }

 private:
  static constexpr double min_change_n = 1.0;
  static constexpr double max_changed_s = 0.05;
  static constexpr double min_force_n = 0.5;
  static constexpr double max_held_s = 3.0;
  core::Vec3 since_change_n_{core::Vec3::Zero()};
  double changed_s_{0.0};
  double held_s_{0.0};
};
}  // namespace tapstudy::device
