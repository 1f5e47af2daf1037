#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// A reading as one number: two that differ in a bit have the same one about never.
template <class Values>
std::uint64_t fingerprint_of(const Values& values, std::uint64_t before = 1) noexcept {
  constexpr std::uint64_t odd = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio
  constexpr int half = 32;
  for (const auto value : values) {
    before = (before ^ std::bit_cast<std::uint64_t>(value)) * odd;
    before ^= before >> half;
  }
  return before;
}

// Finds readings that go round in a circle of at most 256, to the bit: a driver that hands out a
// ring of old samples, which nobody fills any more. Four rounds, of 128 readings at least, are no
// chance.
class ReadingCircle {
 public:
  void take(std::uint64_t reading) noexcept {
    if (length_ == 0 || before(length_) != reading) {
      length_ = newest_at(reading);
      taken_ = changes_ = 0;
    }
    ++taken_;
    changes_ += reading == before(1) ? 0 : 1;
    newest_[reading % longest] = next_;
    ring_[next_++ % longest] = reading;
  }
  bool goes_round() const noexcept {
    return length_ > 1 && taken_ >= std::max(min_rounds * length_, min_taken);
  }
  // With so many changes that no hand, and no noise on a position at rest, could repeat them.
  bool is_lively() const noexcept { return goes_round() && changes_ >= min_changes; }

 private:
  static constexpr std::size_t longest = 256;
  static constexpr std::size_t min_rounds = 4;
  static constexpr std::size_t min_taken = 128;
  static constexpr std::size_t min_changes = 32;
  std::uint64_t before(std::size_t readings) const noexcept {
    return ring_[(next_ - readings) % longest];
  }
  // So many readings ago; 0: not among those that are remembered, of which each may have displaced
  // another.
  std::size_t newest_at(std::uint64_t reading) const noexcept {
    const std::size_t readings = next_ - newest_[reading % longest];
    return readings <= longest && before(readings) == reading ? readings : 0;
  }
  std::array<std::uint64_t, longest> ring_{};
  std::array<std::size_t, longest> newest_{};  // by the reading's last digits
  std::size_t next_{longest};
  std::size_t length_{0};
  std::size_t taken_{0};
  std::size_t changes_{0};
};

// Finds a device that goes on replying while its position stands still to the bit: its encoders
// have no supply, or the thread that reads them has died. So does a program that goes through old
// samples again and again, such as two buffers of which neither is filled any more: a reading that
// was there within the last 10 ms, to the bit, is no movement. A hand that trembles, at 8 to 12 Hz,
// is back after 40 ms at the earliest. Readings that go round in a longer circle are none, either;
// in a lively one they are a fault as soon as there is force.
//
// A hand at rest, too, may leave every counter as it is for a while, so that only two things are a
// fault.
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
  FrozenReading() = default;
  // max_held_s: 3 s, where every movement is in the reading.
  explicit FrozenReading(double max_held_s) noexcept : max_held_s_{max_held_s} {}
  void forget() noexcept { *this = FrozenReading{max_held_s_}; }
  // Once a reading, by its fingerprint, with the force commanded before it and the time since the
  // reading before.
  [[nodiscard]] bool judge(std::uint64_t reading, const core::Vec3& force_n,
                           double elapsed_s) noexcept {
    circle_.take(reading);
    const bool is_force = force_n.squaredNorm() >= min_force_n * min_force_n;
    if (circle_.is_lively() && is_force) {
      return true;
    }
    if (!was_there(reading, elapsed_s) && !circle_.goes_round()) {
      since_change_n_ = force_n;
      changed_s_ = held_s_ = 0.0;
      return false;
    }
    changed_s_ = (force_n - since_change_n_).squaredNorm() >= min_change_n * min_change_n
                     ? changed_s_ + elapsed_s
                     : 0.0;
    held_s_ = is_force ? held_s_ + elapsed_s : 0.0;
    return changed_s_ > max_changed_s || held_s_ > max_held_s_;
  }

 private:
  struct Seen {
    std::uint64_t reading{0};
    double at_s{-std::numeric_limits<double>::infinity()};
  };
  static constexpr std::size_t remembered = 8;
  static constexpr double memory_s = 0.01;
  // Or is the one before, however long ago that was.
  bool was_there(std::uint64_t reading, double elapsed_s) noexcept {
    now_s_ += elapsed_s;
    const auto known = std::ranges::find(seen_, reading, &Seen::reading);
    const auto latest = std::ranges::max_element(seen_, {}, &Seen::at_s);
    const bool is_known =
        known != seen_.end() && (known == latest || known->at_s >= now_s_ - memory_s);
    *(known != seen_.end() ? known : std::ranges::min_element(seen_, {}, &Seen::at_s)) = {reading,
                                                                                          now_s_};
    return is_known;
  }

  static constexpr double min_change_n = 1.0;
  static constexpr double max_changed_s = 0.05;
  static constexpr double min_force_n = 0.5;
  double max_held_s_{3.0};
  std::array<Seen, remembered> seen_{};
  ReadingCircle circle_;
  double now_s_{0.0};
  core::Vec3 since_change_n_{core::Vec3::Zero()};
  double changed_s_{0.0};
  double held_s_{0.0};
};
}  // namespace tapstudy::device
