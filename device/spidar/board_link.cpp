#include "device/spidar/board_link.hpp"

#include <algorithm>
#include <utility>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double max_guardian_silence_s = 0.1;
constexpr int max_late_replies = 8;  // that are told apart

TickFault fault_of(UsbOutcome outcome) noexcept {
  switch (outcome) {
    case UsbOutcome::ok:
      return TickFault::none;
    case UsbOutcome::timed_out:
      return TickFault::no_reply;
    case UsbOutcome::gone:
      return TickFault::device_gone;
    default:
      return TickFault::bad_reply;
  }
}
}  // namespace

BoardLink::BoardLink(UsbPipe& pipe, SpidarBoard& board, WatchdogChannel* watchdog,
                     double dt_s) noexcept
    : pipe_{pipe}, board_{board}, watchdog_{watchdog}, dt_s_{dt_s} {}

UsbOutcome BoardLink::open() noexcept {
  const UsbOutcome outcome = board_.begin(pipe_, reading_);
  if (outcome == UsbOutcome::ok && watchdog_ != nullptr) {
    watchdog_->allow_power();
  }
  return outcome;
}

bool BoardLink::is_watched() const noexcept {
  return watchdog_ != nullptr && watchdog_->is_on();
}

TickFault BoardLink::begin_watch() noexcept {
  guardian_silent_s_ = 0.0;
  if (std::exchange(missed_replies_, 0) > 0) {
    pipe_.drain();  // they may have come since
  }
  if (watchdog_ == nullptr) {
    return TickFault::none;
  }
  if (!is_guardian_alive(*watchdog_)) {
    return TickFault::guardian_lost;
  }
  guardian_rounds_ = watchdog_->rounds();
  watchdog_->begin();
  return TickFault::none;
}

void BoardLink::end_watch() noexcept {
  is_force_off_ = true;
  if (watchdog_ != nullptr) {
    watchdog_->end();
    watchdog_->pause_repeating(false);
  }
}

// The guardian and this process monitor each other. A pause of the loop is no silence of the
// guardian, so a tick counts for one period at most.
TickFault BoardLink::fault_of_watchdog(double elapsed_s) noexcept {
  if (!is_watched()) {
    return TickFault::none;
  }
  watchdog_->beat();
  const bool is_silent = watchdog_->rounds() == guardian_rounds_;
  guardian_rounds_ = watchdog_->rounds();
  guardian_silent_s_ = is_silent ? guardian_silent_s_ + std::min(elapsed_s, dt_s_) : 0.0;
  if (watchdog_->has_acted()) {
    return TickFault::watchdog_expired;
  }
  return guardian_silent_s_ > max_guardian_silence_s ? TickFault::guardian_lost : TickFault::none;
}

// A reply that was missed may still come, and must not be taken for the next one: requests differ
// from then on, by some counts of one string (8: about 50 mN), so that their echoes do.
UsbOutcome BoardLink::exchange_as_owner(DacCounts outputs) noexcept {
  if (missed_replies_ > 0) {
    pipe_.drain();
    const int marked = outputs.front() + 1 + (missed_replies_ - 1) % max_late_replies;
    outputs.front() = static_cast<std::uint16_t>(std::min<int>(marked, max_dac_counts));
  }
  is_force_off_ = false;
  UsbOutcome outcome = board_.exchange(pipe_, outputs, reading_);
  sent_before_ = std::exchange(sent_, outputs);
  const int may_come = std::min(missed_replies_, max_late_replies);
  for (int i = 0; i < may_come && outcome == UsbOutcome::ok && !is_echo_right(); ++i) {
    outcome = board_.receive(pipe_, reading_);
  }
  return outcome;
}

TickFault BoardLink::exchange(const DacCounts& outputs, double elapsed_s) noexcept {
  if (const TickFault fault = fault_of_watchdog(elapsed_s); fault != TickFault::none) {
    return fault;
  }
  const bool is_claimed = is_watched();
  if (is_claimed && !watchdog_->claim_output()) {
    return TickFault::watchdog_expired;
  }
  const UsbOutcome outcome = exchange_as_owner(outputs);
  if (is_claimed && !watchdog_->release_output()) {
    return TickFault::watchdog_expired;  // in the middle of the exchange
  }
  const bool is_stale = outcome == UsbOutcome::ok && missed_replies_ > 0 && !is_echo_right();
  if (outcome == UsbOutcome::timed_out || is_stale) {
    ++missed_replies_;
    return TickFault::no_reply;
  }
  missed_replies_ = 0;
  if (outcome != UsbOutcome::ok) {
    return fault_of(outcome);
  }
  return is_echo_right() ? TickFault::none : TickFault::wrong_echo;
}

// It is not documented whether the echo is of this request or of the previous one: this is
// determined as soon as the two differ, and enforced from then on. A reply that is a tick late
// matches neither.
bool BoardLink::is_echo_right() noexcept {
  if (!reading_.echo) {
    return true;
  }
  const bool is_of_this = *reading_.echo == sent_;
  const bool is_of_the_one_before = *reading_.echo == sent_before_;
  if (is_of_this != is_of_the_one_before && !echoes_this_request_) {
    echoes_this_request_ = is_of_this;
  }
  return echoes_this_request_.value_or(is_of_this) ? is_of_this : is_of_the_one_before;
}

// Asked again while the guardian repeats zero force: it has to have finished its round.
void BoardLink::take_over_from_guardian() noexcept {
  if (watchdog_ != nullptr && watchdog_->must_repeat()) {
    watchdog_->pause_repeating(true);
    static_cast<void>(is_guardian_alive(*watchdog_));
  }
}

StopOutcome BoardLink::stop(bool is_counting) noexcept {
  is_counting_ = is_counting;
  take_over_from_guardian();
  bool has_late_reply = missed_replies_ > 0;
  for (int i = 0; i < zero_force_packets; ++i) {
    if (is_watched()) {
      watchdog_->beat();
    }
    const ZeroExchange zeros = exchange_zeros(board_, pipe_);
    has_late_reply = has_late_reply || zeros.outcome == UsbOutcome::timed_out;
    is_force_off_ =
        zeros.is_confirmed && is_counting;  // the last one counts: earlier replies may be stale
  }
  if (has_late_reply) {
    pipe_.drain();  // else every later reply would be one exchange old
  }
  sent_ = sent_before_ = DacCounts{};
  missed_replies_ = 0;
  if (is_force_off_) {
    end_watch();
    return StopOutcome::confirmed;
  }
  if (watchdog_ != nullptr) {
    watchdog_->repeat_zero_force();
    watchdog_->pause_repeating(false);
  }
  return StopOutcome::unconfirmed;
}

bool BoardLink::is_force_off() const noexcept {
  return is_force_off_ || (is_counting_ && watchdog_ != nullptr && watchdog_->is_zero_confirmed());
}
}  // namespace tapstudy::device
