#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/random/rng.hpp"
#include "device/remote/datagram_pipe.hpp"
#include "device/remote/packets.hpp"
#include "support/staged_loop.hpp"
namespace tapstudy::testing {
enum class RemoteTrouble {
  none,
  deaf,  // takes datagrams, obeys and answers nothing
  mute,  // obeys, and does not answer
  short_reply,
  old_number,
  twice,          // sends each reply two times
  not_a_number,   // the position
  jump,           // of the position
  dead_thread,    // the newest sample stays the newest
  old_sample,     // is told under new numbers
  two_buffers,    // of old samples are told in turn, under new numbers
  ring,           // of 32 old samples, likewise
  dead_encoders,  // the position stands still, and the velocity that is measured apart is noise
  samples_jump,   // their numbers
  samples_fall,   // likewise, to before
  too_old,        // the age of the sample
  no_power,
  must_be_homed,
  overload,       // exerts far more than it was sent
  never_lets_go,  // exerts what it did, whatever it is sent
  limp,           // exerts nothing
  reversed,       // exerts the force the other way round
  sideways,       // exerts it along another axis
  half_known,     // tells of one axis of the force only
  tells_no_more,  // what it exerts
  falls_back,     // to version 1
  coarse,         // its gauge is noisy
  releases,       // as after a silence
  every_other,    // request is answered
  no_unit,        // quaternion
  rude_text,      // obeyed by terminals
  gone
};

// A program that drives a device, of one version of the protocol: a finger held by a muscle, pushed
// by the force. Time passes only while it is waited for; a datagram takes none, and datagrams are
// obeyed one after the other.
class RemoteProgram final : public device::DatagramPipe {
 public:
  using Nanoseconds = device::Nanoseconds;
  using DatagramOutcome = device::DatagramOutcome;
  explicit RemoteProgram(int speaks = 1) : version{speaks} {}

  RemoteTrouble trouble{RemoteTrouble::none};
  int version;
  Nanoseconds reply_delay{0};
  Nanoseconds release_after{std::numeric_limits<Nanoseconds>::max()};  // so long a silence
  double gauge_lag_s{0.0};
  double height_m{0.01};
  double tremor_m{0.0};  // 9 times a second
  double velocity_m_s{0.0};
  double exerted_n{0.0};
  int forces_since_trouble{0};
  int answered{0};
  int samples_left{std::numeric_limits<int>::max()};  // then the newest stays the newest
  double age_s{1e-4};                                 // of a sample
  device::wire::Introduction introduction{.workspace_radius_m = 0.1,
                                          .max_force_n = 5.0,
                                          .max_stiffness_n_per_m = 5000.0,
                                          .rate_hz = 1000.0,
                                          .release_s = 0.02,
                                          .name = {"a mock"},
                                          .serial_number = {"M1"}};

  // As where it is ended and started anew: samples are numbered anew.
  void restart() {
    sample_ = 0;
    exerted_n = 0.0;
    has_released_ = true;
  }
  // The finger goes up so far and down again, 2.5 times a second, from where it is now on.
  void tap(double by_m) {
    tap_m_ = by_m;
    tapping_since_ = now_;
  }
  Nanoseconds now() noexcept override { return now_; }
  void wait_until(Nanoseconds moment) noexcept override {
    while (!requests_.empty() && free_at_ <= moment) {
      now_ = std::max(now_, free_at_);
      const std::vector<std::uint8_t> request = std::move(requests_.front());
      requests_.pop_front();
      if (trouble != RemoteTrouble::deaf) {
        obey(request);
      }
    }
    now_ = std::max(now_, moment);
    if (now_ - heard_at_ > release_after) {
      exerted_n = 0.0;
      has_released_ = true;
    }
  }
  // As the loopback does: a closed port is told of by what follows the first datagram.
  DatagramOutcome send(std::span<const std::uint8_t> out) noexcept override {
    if (trouble == RemoteTrouble::gone) {
      return std::exchange(is_refused_, true) ? DatagramOutcome::gone : DatagramOutcome::ok;
    }
    requests_.emplace_back(out.begin(), out.end());
    wait_until(now_);
    return DatagramOutcome::ok;
  }
  device::ReceivedDatagram receive(std::span<std::uint8_t> in,
                                   Nanoseconds deadline) noexcept override {
    if (std::exchange(is_refused_, false)) {
      return {DatagramOutcome::gone, 0};
    }
    while (now_ <= deadline) {
      if (!replies_.empty() && replies_.front().at <= now_) {
        const Reply reply = std::move(replies_.front());
        replies_.pop_front();
        const std::size_t length = std::min(in.size(), reply.bytes.size());
        std::copy_n(reply.bytes.begin(), length, in.begin());
        return {DatagramOutcome::ok, length};
      }
      if (now_ == deadline) {
        break;
      }
      const Nanoseconds next_reply = replies_.empty() ? deadline : replies_.front().at;
      const Nanoseconds next_request = requests_.empty() ? deadline : free_at_;
      wait_until(std::min({deadline, next_reply, std::max(next_request, now_)}));
    }
    return {DatagramOutcome::timed_out, 0};
  }

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Reply {
    Nanoseconds at;
    Bytes bytes;
  };
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  template <class Value>
  static Value at(const Bytes& bytes, std::size_t place) {
    Value value{};
    std::memcpy(&value, bytes.data() + place, sizeof value);
    return value;
  }
  template <class Value>
  static Bytes bytes_of(const Value& value) {
    Bytes bytes(sizeof value);
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
  }

  void obey(const Bytes& request) {
    const bool is_of_3 = request.size() == sizeof(device::wire::Request);
    if (is_of_3 != (version == 3)) {
      return;  // of another version
    }
    const auto kind = at<std::uint32_t>(request, 4);
    const auto number = at<std::uint32_t>(request, 8);
    if (is_of_3 && kind == 3) {
      introduction.request = number;
      answer(bytes_of(introduction));
      return;
    }
    heard_at_ = now_;
    exert(at<double>(request, is_of_3 ? 24 : 20));
    const bool is_asked = kind == 1;
    const bool is_left_out = trouble == RemoteTrouble::every_other && is_asked && ++asked_ % 2 == 0;
    if (is_asked && trouble != RemoteTrouble::mute && !is_left_out) {
      const std::uint32_t told = number - (trouble == RemoteTrouble::old_number ? 1 : 0);
      answer(is_of_3 ? reply_of_3(told) : older_reply(told));
      has_released_ = false;
    }
  }
  void exert(double force_n) {
    if (trouble != RemoteTrouble::never_lets_go) {
      exerted_n = force_n;
    }
    forces_since_trouble += trouble != RemoteTrouble::none && force_n > 0.0 ? 1 : 0;
  }
  void answer(Bytes bytes) {
    free_at_ = now_ + reply_delay;
    if (trouble == RemoteTrouble::short_reply) {
      bytes.resize(bytes.size() / 2);
    }
    replies_.push_back({free_at_, bytes});
    if (trouble == RemoteTrouble::twice) {
      replies_.push_back({free_at_, bytes});
    }
    ++answered;
  }
  std::uint32_t status() const {
    using namespace device::wire;
    return (trouble == RemoteTrouble::no_power ? 0 : motors_on) |
           (trouble == RemoteTrouble::releases || has_released_ ? force_was_released : 0) |
           (trouble == RemoteTrouble::must_be_homed ? must_be_homed : 0);
  }
  double tap_phase() const {
    constexpr double taps_a_second = 2.5;
    return 2.0 * std::numbers::pi * taps_a_second * 1e-9 *
           static_cast<double>(now_ - tapping_since_);
  }
  double told_velocity_m_s() {
    constexpr double phase_a_second = 2.0 * std::numbers::pi * 2.5;
    const double noise_m_s = trouble == RemoteTrouble::dead_encoders ? 1e-4 * rng_.normal() : 0.0;
    return velocity_m_s + noise_m_s + 0.5 * tap_m_ * phase_a_second * std::sin(tap_phase());
  }
  double trembling_m() const {
    constexpr double tremor_a_second = 2.0 * std::numbers::pi * 9.0;
    constexpr double between_buffers_m = 1e-5;
    const bool is_still =
        trouble == RemoteTrouble::old_sample || trouble == RemoteTrouble::dead_encoders;
    return trouble == RemoteTrouble::two_buffers ? (answered % 2 == 0 ? between_buffers_m : 0.0)
           : trouble == RemoteTrouble::ring ? between_buffers_m * std::sin(0.1 * (answered % 32))
           : is_still                       ? 0.0
                      : tremor_m * std::sin(tremor_a_second * 1e-9 * static_cast<double>(now_));
  }
  double told_height_m() const {
    const double tapping_m = 0.5 * tap_m_ * (1.0 - std::cos(tap_phase()));
    return trouble == RemoteTrouble::not_a_number ? nan
           : trouble == RemoteTrouble::jump       ? 0.3
                                                  : height_m + tapping_m + trembling_m();
  }
  device::wire::Vector told_force_n() {
    const double told_n = measured_n();
    if (trouble == RemoteTrouble::tells_no_more) {
      return {nan, nan, nan};
    }
    if (trouble == RemoteTrouble::sideways) {
      return {told_n, 0.0, 0.0};
    }
    return {trouble == RemoteTrouble::half_known ? nan : 0.0, told_n, 0.0};
  }
  Bytes older_reply(std::uint32_t number) {
    const std::uint32_t told =
        trouble == RemoteTrouble::falls_back ? 1U : static_cast<std::uint32_t>(version);
    Bytes reply(told == 2 ? 88 : 60);
    const auto put = [&](std::size_t place, const auto& value) {
      std::memcpy(reply.data() + place, &value, sizeof value);
    };
    put(0, device::wire::Mark{'T', 'A', 'P', 'R'});
    put(4, told);
    put(8, number);
    put(12, device::wire::Vector{0.0, told_height_m(), 0.0});
    put(36, device::wire::Vector{0.0, told_velocity_m_s(), 0.0});
    if (told == 2) {
      put(60, status());
      put(64, told_force_n());
    }
    return reply;
  }
  Bytes reply_of_3(std::uint32_t number) {
    device::wire::Reply reply;
    reply.request = number;
    take_sample();
    reply.sample = sample_ + (trouble == RemoteTrouble::samples_jump ? 1'000'000 : 0) -
                   (trouble == RemoteTrouble::samples_fall ? 500 : 0);
    reply.age_s = trouble == RemoteTrouble::too_old ? 0.006 : age_s;
    reply.position_m = {0.0, told_height_m(), 0.0};
    reply.velocity_m_s = {0.0, told_velocity_m_s(), 0.0};
    reply.orientation[0] = trouble == RemoteTrouble::no_unit ? 1.01 : 1.0;
    reply.exerted_n = told_force_n();
    reply.status = status();
    reply.text[0] = trouble == RemoteTrouble::rude_text ? '\x1b' : '\0';
    return bytes_of(reply);
  }
  // At its rate, and when it is asked.
  void take_sample() {
    if (trouble != RemoteTrouble::dead_thread && samples_left > 0 && now_ >= next_sample_at_) {
      ++sample_;
      --samples_left;
      next_sample_at_ = now_ + std::llround(1e9 / introduction.rate_hz);
    }
  }
  double measured_n() {
    gauge_.push_back({now_, exerted_n});
    const auto lag = static_cast<Nanoseconds>(1e9 * gauge_lag_s);
    while (gauge_.size() > 1 && gauge_[1].first <= now_ - lag) {
      gauge_.pop_front();
    }
    const double delayed_n = gauge_.front().first <= now_ - lag ? gauge_.front().second : 0.0;
    switch (trouble) {
      case RemoteTrouble::overload:
        return 80.0;
      case RemoteTrouble::limp:
        return 0.0;
      case RemoteTrouble::reversed:
        return -exerted_n;
      case RemoteTrouble::coarse:
        return exerted_n + 0.1 * rng_.normal();
      default:
        return delayed_n;
    }
  }

  core::Rng rng_{1};
  std::deque<std::pair<Nanoseconds, double>> gauge_;
  std::uint64_t sample_{1000};
  Nanoseconds next_sample_at_{0};
  double tap_m_{0.0};
  Nanoseconds tapping_since_{0};
  int asked_{0};
  Nanoseconds now_{0};
  Nanoseconds heard_at_{0};
  bool has_released_{false};
  Nanoseconds free_at_{0};
  std::deque<Bytes> requests_;
  std::deque<Reply> replies_;
  bool is_refused_{false};
};

using ProgramClock = ClockOf<RemoteProgram>;
}  // namespace tapstudy::testing
