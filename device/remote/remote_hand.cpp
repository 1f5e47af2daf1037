#include "device/remote/remote_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "device/remote/packets.hpp"
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double max_ratio = 2.0;
constexpr double margin_n = 1.0;
constexpr double max_above_s = 0.0025;
constexpr double max_against_s = 0.0055;
constexpr double min_ratio = 0.05;
constexpr double max_without_s = max_report_lag_s + 0.03;

void count(double& total_s, bool is_so, double elapsed_s) noexcept {
  total_s = is_so ? total_s + elapsed_s : 0.0;
}
}  // namespace

void ExertedForce::remember(const core::Vec3& commanded_n, double elapsed_s) noexcept {
  current_s_ += elapsed_s;
  if (current_s_ > 0.5 * max_report_lag_s) {
    recent_ = {Commands{commanded_n, commanded_n}, recent_[0], recent_[1]};
    current_s_ = 0.0;
  }
  recent_[0].low_n = recent_[0].low_n.cwiseMin(commanded_n);
  recent_[0].high_n = recent_[0].high_n.cwiseMax(commanded_n);
}

double ExertedForce::largest_along(const core::Vec3& direction) const noexcept {
  double largest = 0.0;
  for (const Commands& commands : recent_) {
    const core::Vec3 furthest = (direction.array() > 0.0).select(commands.high_n, commands.low_n);
    largest = std::max(largest, furthest.dot(direction));
  }
  return largest;
}

TickFault ExertedForce::judge(const core::Vec3& commanded_n, const core::Vec3& reported_n,
                              double elapsed_s) noexcept {
  remember(commanded_n, elapsed_s);
  const double commanded = commanded_n.norm();
  const double reported = reported_n.norm();
  if (std::isnan(reported)) {
    return TickFault::none;
  }
  const double explained_n = reported > 0.0 ? largest_along(reported_n / reported) : 0.0;
  const bool is_force = commanded >= noticeable_n;
  const double along = is_force ? reported_n.dot(commanded_n) / commanded : 0.0;
  count(above_s_, reported > max_ratio * explained_n + margin_n, elapsed_s);
  count(against_s_, along <= -noticeable_n && explained_n < min_ratio * reported, elapsed_s);
  count(without_s_, is_force && along < min_ratio * commanded, elapsed_s);
  return above_s_ > max_above_s || against_s_ > max_against_s || without_s_ > max_without_s
             ? TickFault::force_not_followed
             : TickFault::none;
}

using core::TickFault;
namespace {
constexpr double window_length_s = 0.05;
constexpr double noticeable_m = 0.002;
constexpr double tolerance = 0.5;
constexpr int max_disagreements = 20;
}  // namespace

TickFault VelocityCheck::judge(const core::HandState& hand, double elapsed_s) noexcept {
  if (has_begun_) {
    integrated_m_ += elapsed_s * hand.velocity_m_s;
    window_s_ += elapsed_s;
    if (window_s_ < window_length_s) {
      return TickFault::none;
    }
    const core::Vec3 moved_m = hand.position_m - began_at_m_;
    const double larger_m = std::max(moved_m.norm(), integrated_m_.norm());
    if (larger_m >= noticeable_m) {
      const bool agrees = (moved_m - integrated_m_).norm() <= tolerance * larger_m;
      disagreements_ = std::max(disagreements_ + (agrees ? -1 : 1), 0);
    }
  }
  has_begun_ = true;
  began_at_m_ = hand.position_m;
  integrated_m_.setZero();
  window_s_ = 0.0;
  return disagreements_ > max_disagreements ? TickFault::velocity_wrong : TickFault::none;
}

using core::TickFault;
namespace {
constexpr double untold = std::numeric_limits<double>::quiet_NaN();
constexpr int max_zero_force_requests = 30;  // a device may measure its force late
constexpr int attempts = 40;
constexpr int measured_round_trips = 200;
constexpr int max_released_replies = 30;  // after a silence, until the other program holds again
constexpr std::chrono::milliseconds patience{50};  // timeout per attempt
}  // namespace

RemoteHand::RemoteHand(std::uint16_t port, std::chrono::microseconds max_reply)
    : RemoteHand{port, max_reply, open_udp_pipe(port)} {}

RemoteHand::RemoteHand(std::uint16_t port, std::chrono::microseconds max_reply,
                       std::unique_ptr<DatagramPipe> pipe)
    : port_{port}, max_reply_{patience}, pipe_{std::move(pipe)} {
  core::HandState ignored;
  bool is_misunderstood = false;
  for (int i = 0; i < attempts; ++i) {
    const TickFault fault = ask(ignored);
    if (fault == TickFault::none) {
      max_reply_ = max_reply;
      return;
    }
    is_misunderstood = is_misunderstood || fault == TickFault::bad_reply;
    sleep_for(patience);
  }
  throw DeviceError{
      is_misunderstood
          ? fmt::format(
                "remote: replies come from 127.0.0.1, UDP port {}, but not as version 1 or 2 "
                "of the protocol (device/remote/packets.hpp)",
                port)
          : fmt::format("remote: nobody answers at 127.0.0.1, UDP port {} (is the program that "
                        "drives the device running?)",
                        port)};
}

RemoteHand::~RemoteHand() {
  static_cast<void>(RemoteHand::zero_force());
}

std::string RemoteHand::description() const {
  return fmt::format("remote device at UDP port {}", port_);
}

TickFault RemoteHand::send(bool wants_reply) noexcept {
  const auto bytes =
      encoded({wants_reply ? RequestKind::reply : RequestKind::no_reply, ++number_, force_n_});
  switch (pipe_->send(bytes)) {
    case DatagramOutcome::ok:
      return TickFault::none;
    case DatagramOutcome::gone:
      return TickFault::device_gone;
    case DatagramOutcome::timed_out:
    case DatagramOutcome::failed:
      break;
  }
  return TickFault::bad_reply;
}

void RemoteHand::sleep_for(std::chrono::nanoseconds duration) noexcept {
  pipe_->wait_until(pipe_->now() + duration.count());
}

// Late replies to earlier requests are ignored.
TickFault RemoteHand::receive(core::HandState& hand) noexcept {
  const Nanoseconds deadline = pipe_->now() + max_reply_.count();
  while (true) {
    std::array<std::uint8_t, reply_bytes_of_version_2 + 1> bytes{};
    const ReceivedDatagram received = pipe_->receive(bytes, deadline);
    if (received.outcome != DatagramOutcome::ok) {
      return received.outcome == DatagramOutcome::gone ? TickFault::device_gone
                                                       : TickFault::no_reply;
    }
    const auto reply = decoded_reply(std::span{bytes}.first(received.bytes));
    if (!reply) {
      return TickFault::bad_reply;
    }
    if (reply->number == number_) {
      if (tells_status_ && !reply->status) {
        return TickFault::bad_reply;
      }
      tells_status_ = reply->status.has_value();
      hand = reply->hand;
      status_ = reply->status;
      detail_.achieved_n = reply->exerted_n.value_or(core::Vec3::Constant(untold));
      return TickFault::none;
    }
  }
}

TickFault RemoteHand::ask(core::HandState& hand) noexcept {
  const TickFault fault = send(true);
  return fault == TickFault::none ? receive(hand) : fault;
}

TickFault RemoteHand::begin() noexcept {
  held_.forget();
  exerted_.forget();
  velocity_.forget();
  reading_.forget();
  since_reply_s_ = 0.0;
  is_holding_ = false;
  released_replies_ = 0;
  detail_.missed_replies = 0;
  return TickFault::none;
}

// Between trials nobody asks, so that the first replies may report a release; not all of them.
TickFault RemoteHand::fault_of_report(double elapsed_s) noexcept {
  const std::uint32_t status = status_.value_or(motors_on);
  if ((status & motors_on) == 0) {
    return TickFault::amplifier_off;
  }
  const bool has_released = (status & force_was_released) != 0;
  released_replies_ = has_released ? released_replies_ + 1 : 0;
  if (has_released && (is_holding_ || released_replies_ > max_released_replies)) {
    return TickFault::force_released;
  }
  is_holding_ = is_holding_ || !has_released;
  return exerted_.judge(force_n_, detail_.achieved_n, elapsed_s);
}

// Protocols 1 and 2 do not number their samples: one that is repeated is known by its bits.
TickFault RemoteHand::fault_of_motion(const core::HandState& hand, double elapsed_s) noexcept {
  const core::HandState last = std::exchange(last_, hand);
  const bool is_same = last.position_m == hand.position_m && last.velocity_m_s == hand.velocity_m_s;
  return reading_.judge(is_same, force_n_, elapsed_s) ? TickFault::position_frozen
                                                      : velocity_.judge(hand, elapsed_s);
}

TickFault RemoteHand::read(core::HandState& hand, double elapsed_s) noexcept {
  since_reply_s_ += elapsed_s;
  const TickFault fault = ask(hand);
  if (fault == TickFault::no_reply && held_.use_last_reading(hand)) {
    detail_.missed_replies = held_.missed_replies();
    detail_.achieved_n.setConstant(untold);
    return TickFault::none;
  }
  if (fault != TickFault::none) {
    return fault;
  }
  detail_.missed_replies = 0;
  held_.keep(hand);
  const double since_s = std::exchange(since_reply_s_, 0.0);
  const TickFault of_report = fault_of_report(since_s);
  return of_report != TickFault::none ? of_report : fault_of_motion(hand, since_s);
}

TickFault RemoteHand::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  return send(false);
}

// The first reply may still report a release in an earlier silence.
RemoteHand::Release RemoteHand::release_after(std::chrono::milliseconds silence) noexcept {
  const auto reported = [this]() -> std::optional<bool> {
    status_.reset();
    core::HandState ignored;
    if (ask(ignored) != TickFault::none || !status_) {
      return std::nullopt;
    }
    return (*status_ & force_was_released) != 0;
  };
  std::optional<bool> before;
  for (int i = 0; i < max_released_replies; ++i) {
    before = reported();
    if (!before) {
      return Release::not_reported;
    }
    if (!*before) {
      break;
    }
  }
  if (*before) {
    return Release::always_reported;
  }
  sleep_for(silence);
  const std::optional<bool> after = reported();
  return !after ? Release::not_reported : *after ? Release::released : Release::held;
}

LatenessCount RemoteHand::round_trips() noexcept {
  force_n_ = core::Vec3::Zero();
  LatenessCount times;
  for (int i = 0; i < measured_round_trips; ++i) {
    const Nanoseconds start = pipe_->now();
    core::HandState ignored;
    const bool has_replied = ask(ignored) == TickFault::none;
    times.add(has_replied ? pipe_->now() - start : max_reply_.count());
  }
  return times;
}

// Confirmed by a reply to a request that carried zero force, and that does not report another; the
// last one counts. While another is reported, it is asked again every millisecond.
StopOutcome RemoteHand::zero_force() noexcept {
  force_n_ = core::Vec3::Zero();
  bool has_replied = true;
  bool is_exerted = false;
  for (int i = 0;
       i < zero_force_packets || (has_replied && is_exerted && i < max_zero_force_requests); ++i) {
    if (i >= zero_force_packets) {
      sleep_for(std::chrono::milliseconds{1});
    }
    core::HandState ignored;
    has_replied = ask(ignored) == TickFault::none;
    is_exerted = detail_.achieved_n.norm() >= noticeable_n;  // not so if it is not reported, NaN
  }
  return has_replied && !is_exerted ? StopOutcome::confirmed : StopOutcome::unconfirmed;
}
}  // namespace tapstudy::device
