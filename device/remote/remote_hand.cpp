#include "device/remote/remote_hand.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <utility>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double untold = std::numeric_limits<double>::quiet_NaN();
constexpr int attempts = 40;
constexpr int measured_round_trips = 200;
// After a silence, until the other program holds again.
constexpr double max_released_s = 0.03;
constexpr int max_released_replies = 30;
constexpr std::chrono::milliseconds patience{50};  // timeout per attempt

enum class Taken : std::uint8_t { yes, not_this, broken };
}  // namespace

RemoteHand::RemoteHand(std::uint16_t port, RemoteLimits limits)
    : RemoteHand{port, limits, open_udp_pipe(port)} {}

RemoteHand::RemoteHand(std::uint16_t port, RemoteLimits limits, std::unique_ptr<DatagramPipe> pipe)
    : port_{port},
      max_reply_{patience},
      pipe_{std::move(pipe)},
      samples_{limits.max_sample_age_s, 0.0} {
  bool is_misunderstood = false;
  std::optional<wire::Introduction> told;
  for (int i = 0; i < attempts && version_ == 0; ++i) {
    is_misunderstood = !greet(told) || is_misunderstood;
    if (version_ == 0) {
      sleep_for(patience);
    }
  }
  if (version_ == 0) {
    throw DeviceError{
        is_misunderstood
            ? fmt::format("remote: replies come from 127.0.0.1, UDP port {}, but not as version 1, "
                          "2 or 3 of the protocol (device/remote/README.md)",
                          port)
            : fmt::format("remote: nobody answers at 127.0.0.1, UDP port {} (is the program that "
                          "drives the device running?)",
                          port)};
  }
  max_reply_ = limits.max_reply;
  if (told) {
    told_ = *told;
    introduction_ = description_in(*told);
    samples_ = SampleCheck{limits.max_sample_age_s, introduction_->rate_hz};
  }
}

RemoteHand::~RemoteHand() {
  static_cast<void>(RemoteHand::zero_force());
}

std::string RemoteHand::description() const {
  return introduction_ ? fmt::format("{}, serial number {}, remote/3 at UDP port {}",
                                     introduction_->name, introduction_->serial_number, port_)
                       : fmt::format("remote device at UDP port {}, version {} of the protocol",
                                     port_, version_);
}

// Asks in both ways at once: a program of version 3 answers the first, an older one the second.
// False if what came back was neither.
bool RemoteHand::greet(std::optional<wire::Introduction>& told) {
  const wire::Request introduction{.asked = wire::Asked::introduction, .number = ++number_};
  if (send(encoded(introduction)) != TickFault::none ||
      send(encoded(RemoteRequest{RequestKind::reply, ++number_})) != TickFault::none) {
    return true;
  }
  return receive([&](std::span<const std::uint8_t> bytes) noexcept {
           return is_understood(bytes, told) ? Taken::yes : Taken::broken;
         }) != TickFault::bad_reply;
}

bool RemoteHand::is_understood(std::span<const std::uint8_t> bytes,
                               std::optional<wire::Introduction>& told) noexcept {
  told = decoded_introduction(bytes, number_ - 1);
  const auto reply = decoded_reply(bytes);
  version_ = told ? 3 : reply && reply->version < 3 ? reply->version : 0;
  return version_ != 0;
}

TickFault RemoteHand::send(std::span<const std::uint8_t> datagram) noexcept {
  switch (pipe_->send(datagram)) {
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

TickFault RemoteHand::send_force(RequestKind kind) noexcept {
  ++number_;
  return version_ == 3
             ? send(encoded(wire::Request{.number = number_,
                                          .force_n = {force_n_.x(), force_n_.y(), force_n_.z()}}))
             : send(encoded(RemoteRequest{kind, number_, force_n_}));
}

void RemoteHand::sleep_for(std::chrono::nanoseconds duration) noexcept {
  pipe_->wait_until(pipe_->now() + duration.count());
}

// The first datagram in time that is the one that is waited for.
template <class Take>
TickFault RemoteHand::receive(const Take& take) noexcept {
  const Nanoseconds deadline = pipe_->now() + max_reply_.count();
  while (true) {
    std::array<std::uint8_t, max_reply_datagram_bytes + 1> bytes{};
    const ReceivedDatagram received = pipe_->receive(bytes, deadline);
    if (received.outcome != DatagramOutcome::ok) {
      return received.outcome == DatagramOutcome::gone ? TickFault::device_gone
                                                       : TickFault::no_reply;
    }
    const Taken taken = take(std::span<const std::uint8_t>{bytes}.first(received.bytes));
    if (taken != Taken::not_this) {
      return taken == Taken::yes ? TickFault::none : TickFault::bad_reply;
    }
  }
}

// Late replies to earlier requests are ignored, and so is the second of two.
TickFault RemoteHand::ask() noexcept {
  if (const TickFault fault = send_force(RequestKind::reply); fault != TickFault::none) {
    return fault;
  }
  const TickFault fault = receive([this](std::span<const std::uint8_t> bytes) noexcept {
    const auto reply = decoded_reply(bytes);
    if (!reply || reply->version != version_) {
      return Taken::broken;
    }
    if (reply->number != number_) {
      return Taken::not_this;
    }
    reply_ = *reply;
    return Taken::yes;
  });
  if (fault == TickFault::none) {
    detail_.achieved_n = reply_.exerted_n.value_or(core::Vec3::Constant(untold));
    text_.set(reply_.sample ? reply_.sample->text : decltype(text_)::Characters{});
  }
  return fault;
}

TickFault RemoteHand::begin() noexcept {
  held_.forget();
  exerted_.forget();
  velocity_.forget();
  reading_.forget();
  position_.forget();
  samples_.forget();
  estimate_.forget();
  since_reply_s_ = since_sample_s_ = 0.0;
  is_holding_ = false;
  released_s_ = 0.0;
  detail_.missed_replies = 0;
  detail_.unanswered_s = 0.0;
  return version_ == 3 ? ask_who_it_is() : TickFault::none;
}

// The other program may have been started anew since the last trial, with another device: limits
// and release of that one have not been looked at.
TickFault RemoteHand::ask_who_it_is() noexcept {
  constexpr int max_requests = 3;
  wire::Introduction told;
  TickFault fault = TickFault::no_reply;
  for (int i = 0; i < max_requests && fault == TickFault::no_reply; ++i) {
    fault = send(encoded(wire::Request{.asked = wire::Asked::introduction, .number = ++number_}));
    if (fault == TickFault::none) {
      fault = receive([&](std::span<const std::uint8_t> bytes) noexcept {
        const auto found = decoded_introduction(bytes, number_);
        told = found.value_or(told);
        return found ? Taken::yes : Taken::not_this;
      });
    }
  }
  told.request = told_.request;
  using Bytes = std::array<std::uint8_t, sizeof told>;
  const bool is_same = std::bit_cast<Bytes>(told) == std::bit_cast<Bytes>(told_);
  return fault == TickFault::none && !is_same ? TickFault::device_gone : fault;
}

// Between trials nobody asks, so that the first replies may report a release; not all of them.
TickFault RemoteHand::fault_of_status(std::uint32_t status, double elapsed_s) noexcept {
  if ((status & wire::motors_on) == 0) {
    return TickFault::amplifier_off;
  }
  if (version_ == 3 && (status & wire::must_be_homed) != 0) {
    return TickFault::not_homed;
  }
  const bool has_released = (status & wire::force_was_released) != 0;
  released_s_ = has_released ? released_s_ + elapsed_s : 0.0;
  if (has_released && (is_holding_ || released_s_ > max_released_s)) {
    return TickFault::force_released;
  }
  is_holding_ = is_holding_ || !has_released;
  return TickFault::none;
}

// Versions 1 and 2 do not number their samples: one that is repeated is known by its bits. So is,
// in any version, that of encoders without supply, even where a velocity that is measured apart
// still has noise.
TickFault RemoteHand::fault_of_motion(double elapsed_s) noexcept {
  const std::uint64_t position = fingerprint_of(reply_.hand.position_m);
  const std::uint64_t reading =
      is_velocity_measured_ ? fingerprint_of(reply_.hand.velocity_m_s, position) : position;
  const bool is_still = position_.judge(position, force_n_, elapsed_s);
  return reading_.judge(reading, force_n_, elapsed_s) || is_still
             ? TickFault::position_frozen
             : velocity_.judge(reply_.hand, elapsed_s);
}

void RemoteHand::estimate_velocity(double elapsed_s) noexcept {
  since_sample_s_ += elapsed_s;
  if (samples_.is_new()) {
    estimate_.take(reply_.hand.position_m, std::exchange(since_sample_s_, 0.0));
  }
  reply_.hand.velocity_m_s = estimate_.velocity_m_s();
}

TickFault RemoteHand::take_reply(double elapsed_s) noexcept {
  const TickFault of_sample =
      reply_.sample ? samples_.judge(*reply_.sample, elapsed_s) : TickFault::none;
  is_velocity_measured_ = version_ < 3 || !reply_.hand.velocity_m_s.hasNaN();
  if (!is_velocity_measured_) {
    estimate_velocity(elapsed_s);
  }
  TickFault fault = fault_of_status(reply_.status.value_or(wire::motors_on), elapsed_s);
  if (fault == TickFault::none) {
    fault = of_sample;
  }
  if (fault == TickFault::none) {
    fault = exerted_.judge(force_n_, detail_.achieved_n, elapsed_s);
  }
  return fault == TickFault::none ? fault_of_motion(elapsed_s) : fault;
}

TickFault RemoteHand::read(core::HandState& hand, double elapsed_s) noexcept {
  since_reply_s_ += elapsed_s;
  const TickFault fault = ask();
  if (fault == TickFault::no_reply && held_.use_last_reading(hand, elapsed_s)) {
    detail_.missed_replies = held_.missed_replies();
    detail_.unanswered_s = held_.unanswered_s();
    detail_.achieved_n.setConstant(untold);
    return TickFault::none;
  }
  if (fault != TickFault::none) {
    return fault;
  }
  detail_.missed_replies = 0;
  detail_.unanswered_s = 0.0;
  const double since_reply_s = std::exchange(since_reply_s_, 0.0);
  const TickFault of_reply = take_reply(since_reply_s);
  hand = reply_.hand;
  held_.keep(hand, since_reply_s);
  return of_reply;
}

TickFault RemoteHand::write(const core::Vec3& force_n) noexcept {
  force_n_ = force_n;
  return version_ == 3 ? TickFault::none : send_force(RequestKind::no_reply);
}

// The first reply may still report a release in an earlier silence.
RemoteHand::Release RemoteHand::release_after(std::chrono::milliseconds silence) noexcept {
  const auto reported = [this]() -> std::optional<bool> {
    if (ask() != TickFault::none || !reply_.status) {
      return std::nullopt;
    }
    return (*reply_.status & wire::force_was_released) != 0;
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
    const bool has_replied = ask() == TickFault::none;
    times.add(has_replied ? pipe_->now() - start : max_reply_.count());
  }
  return times;
}
}  // namespace tapstudy::device
