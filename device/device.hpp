#pragma once
#include <limits>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// So many replies in a row may be missing before it is a fault; the loop lets force fade meanwhile.
inline constexpr int max_missed_replies = 3;
// In the long run a tenth may be missing: each counts for ten, and 20 at once are too many.
inline constexpr int replies_for_a_missed_one = 10;
inline constexpr int max_missed_in_debt = 20;

// The hand as last read, which stands in for a reply that is missing.
class HeldHand {
 public:
  void forget() noexcept {
    hand_.reset();
    missed_replies_ = 0;
    debt_ = 0;
  }
  void keep(const core::HandState& hand) noexcept {
    hand_ = hand;
    missed_replies_ = 0;
    debt_ -= debt_ > 0 ? 1 : 0;
  }
  // False where nothing is known, or has stood in for too long.
  bool use_last_reading(core::HandState& hand) noexcept {
    if (!hand_ || missed_replies_ == max_missed_replies ||
        debt_ >= replies_for_a_missed_one * max_missed_in_debt) {
      return false;
    }
    ++missed_replies_;
    debt_ += replies_for_a_missed_one;
    hand = *hand_;
    return true;
  }
  bool is_known() const noexcept { return hand_.has_value(); }
  int missed_replies() const noexcept { return missed_replies_; }

 private:
  std::optional<core::HandState> hand_;
  int missed_replies_{0};
  int debt_{0};  // in replies
};

class DeviceError : public core::Error {
 public:
  using core::Error::Error;
};

// Another program uses the device.
class ClaimedByAnother : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

// Whether the device acknowledged zero force. Unconfirmed: force may still be on.
enum class StopOutcome : std::uint8_t { confirmed, unconfirmed };
// What the operator is told of an unconfirmed stop, and never that force is off.
inline constexpr const char* force_may_be_on = "FORCE MAY STILL BE ON: SWITCH THE AMPLIFIER OFF";

// How many times zero force is sent after a fault, because a packet may be lost.
inline constexpr int zero_force_packets = 3;

// What a device reports about its last tick; NaN: it does not tell.
struct DeviceDetail {
  core::Vec3 achieved_n{core::Vec3::Constant(std::numeric_limits<double>::quiet_NaN())};
  double pose_residual_m{std::numeric_limits<double>::quiet_NaN()};
  double closure_margin{std::numeric_limits<double>::quiet_NaN()};
  double motor_voltage_v{std::numeric_limits<double>::quiet_NaN()};  // mean over the motors
  int missed_replies{0};  // in a row: the position is the last one known
};

// A force-feedback device, real or simulated, as used by the haptic thread: read() and write() are
// called alternately, once per tick. Device frame (core/haptics/haptic_state.hpp). Apart from
// description(), nothing here throws, locks or allocates; an underlying library may: libusb
// allocates two small blocks per pair of transfers, and locks its own mutexes.
class Device {
 public:
  virtual ~Device() = default;
  // On a fault, hand holds whatever could be read; the rest is unchanged.
  // elapsed_s: since the read before, which speeds are computed from.
  [[nodiscard]] virtual core::TickFault read(core::HandState& hand, double elapsed_s) noexcept = 0;
  [[nodiscard]] virtual core::TickFault write(const core::Vec3& force_n) noexcept = 0;
  // Called before the first tick and after a pause; may wait for some milliseconds.
  [[nodiscard]] virtual core::TickFault begin() noexcept { return core::TickFault::none; }
  // Commands zero force; the device stays ready.
  [[nodiscard]] virtual StopOutcome zero_force() noexcept {
    return write(core::Vec3::Zero()) == core::TickFault::none ? StopOutcome::confirmed
                                                              : StopOutcome::unconfirmed;
  }
  // After a fault: sets all outputs to zero immediately, by all available means.
  virtual StopOutcome emergency_stop() noexcept { return zero_force(); }
  // Asked after a stop that was not confirmed: whether the device has confirmed zero force since,
  // for example to a guardian that repeats it.
  virtual bool is_force_off() const noexcept { return false; }
  virtual DeviceDetail detail() const noexcept = 0;
  // Identification, for the session's record.
  virtual std::string description() const = 0;
};
}  // namespace tapstudy::device
