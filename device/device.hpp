#pragma once
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/haptics/haptic_state.hpp"
namespace tapstudy::device {
// So long replies may be missing before it is a fault; the loop lets force fade to nothing
// meanwhile.
inline constexpr double max_unanswered_s = 0.01;
// In the long run they may be missing for a tenth of the time: time without one counts tenfold, and
// 20 ms at once are too much.
inline constexpr double weight_of_unanswered = 10.0;
inline constexpr double max_unanswered_in_debt_s = 0.02;

// The hand as last read, which stands in for a reply that is missing.
class HeldHand {
 public:
  void forget() noexcept { *this = {}; }
  // since_reply_s: from the reply before.
  void keep(const core::HandState& hand, double since_reply_s) noexcept {
    hand_ = hand;
    missed_replies_ = 0;
    unanswered_s_ = 0.0;
    debt_s_ = std::max(0.0, debt_s_ - since_reply_s);
  }
  // False where nothing is known, or has stood in for too long. elapsed_s: since the tick before.
  bool use_last_reading(core::HandState& hand, double elapsed_s) noexcept {
    constexpr double rounding_s = 1e-6;
    unanswered_s_ += elapsed_s;
    if (!hand_ || unanswered_s_ > max_unanswered_s + rounding_s ||
        debt_s_ >= weight_of_unanswered * max_unanswered_in_debt_s) {
      return false;
    }
    ++missed_replies_;
    debt_s_ += weight_of_unanswered * elapsed_s;
    hand = *hand_;
    return true;
  }
  bool is_known() const noexcept { return hand_.has_value(); }
  int missed_replies() const noexcept { return missed_replies_; }
  double unanswered_s() const noexcept { return unanswered_s_; }

 private:
  std::optional<core::HandState> hand_;
  int missed_replies_{0};     // in a row
  double unanswered_s_{0.0};  // since the last one that came
  double debt_s_{0.0};
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
  int missed_replies{0};     // in a row: the position is the last one known
  double unanswered_s{0.0};  // so long it has been
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
