#pragma once
// What a bridge between tapstudy and a device does, whatever the device (remote/3, ../wire.hpp): it
// obeys one sender at a time, and only numbers that rise; limits every force; and exerts none after
// a silence, while the device gives no samples, after it was stopped or hung itself, and when it is
// told to end. A request for an introduction, and what it does not understand, end a force, too.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string_view>

#include "../wire.hpp"

// NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): sockets take addresses in no other way
namespace bridge {
namespace wire = tapstudy::device::wire;
using Clock = std::chrono::steady_clock;
inline constexpr std::chrono::milliseconds max_silence{20};        // then the force is let go
inline constexpr std::chrono::milliseconds until_forgotten{1000};  // then another may begin
inline constexpr double max_sample_age_s = 0.02;                   // then, too

template <std::size_t Size>
void put_text(std::array<char, Size>& field, std::string_view text) {
  field = {};
  text.copy(field.data(), Size - 1);
}

inline double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

// The device behind a bridge.
class Device {
 public:
  Device() = default;
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  Device(Device&&) = delete;
  Device& operator=(Device&&) = delete;
  // The release time is that of the device, should this program die; 0: it tells none.
  virtual wire::Introduction introduction() = 0;
  // Finite, and at most the maximum force of the introduction.
  virtual void exert(const wire::Vector& force_n) = 0;
  // Fills in the newest sample; where the device is gone, none of motors_on, and why as text.
  virtual void sample(wire::Reply& reply) = 0;
  // What is waited for beside requests; -1: nothing. take_input is called when there is some.
  virtual int descriptor() const { return -1; }
  virtual void take_input() {}
};

inline volatile std::sig_atomic_t is_told_to_end = 0;

class Server {
 public:
  Server(int port, Device& device)
      : device_{device},
        introduction_{introduction_of(device)},
        socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
      std::perror("bind");
      std::exit(1);
    }
  }
  ~Server() {
    device_.exert({});
    close(socket_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;

  // Until SIGINT or SIGTERM.
  void run() {
    const auto end = [](int) { is_told_to_end = 1; };
    std::signal(SIGINT, end);
    std::signal(SIGTERM, end);
    while (is_told_to_end == 0) {
      std::array<pollfd, 2> waiting{{{socket_, POLLIN, 0}, {device_.descriptor(), POLLIN, 0}}};
      poll(waiting.data(), waiting.size(), static_cast<int>(max_silence.count() / 4));
      note_silence();  // before anything else: this program may have been stopped
      if (waiting[1].revents != 0) {
        device_.take_input();
      }
      take_datagrams();
    }
  }

 private:
  // Ends the program where it cannot be true: every force is limited by it.
  static wire::Introduction introduction_of(Device& device) {
    wire::Introduction told = device.introduction();
    told.release_s = std::max(told.release_s, std::chrono::duration<double>(max_silence).count());
    for (const wire::Limit& limit : wire::limits) {
      if (!limit.allows(told)) {
        std::fprintf(stderr, "%s: a %s of %g %s: allowed are %g to %g %s\n", told.name.data(),
                     limit.name, told.*limit.value, limit.unit, limit.least, limit.greatest,
                     limit.unit);
        std::exit(1);
      }
    }
    return told;
  }
  // Only the newest of the requests that wait is obeyed. They arrived since the queue was empty:
  // was that longer ago than force outlasts a request, because this program was stopped or hung,
  // they exert nothing.
  void take_datagrams() {
    constexpr int at_most = 1000;
    const Clock::time_point empty_before = empty_at_;
    std::optional<wire::Request> newest;
    for (int i = 0; i < at_most; ++i) {
      const Clock::time_point now = Clock::now();
      if (!take_datagram(newest)) {
        empty_at_ = now;
        break;
      }
    }
    if (newest && Clock::now() - empty_before > max_silence) {
      newest->force_n = {};
      has_released_ = true;
    }
    if (newest) {
      obey(*newest);
    }
  }
  // False if none waits.
  bool take_datagram(std::optional<wire::Request>& newest) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    std::array<char, sizeof(wire::Request) + 1> bytes{};
    const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&from), &size);
    if (count < 0) {
      return errno != EAGAIN;
    }
    const auto request = request_in({bytes.data(), static_cast<std::size_t>(count)});
    if (request && is_next(from, request->number)) {
      listen_to(from);
      number_ = request->number;
      newest = request;
    } else if (!request && has_sender_ && from.sin_port == sender_.sin_port) {
      let_go(newest);
    }
    return true;
  }
  // What is not understood is no reason to go on with the force before it.
  void let_go(std::optional<wire::Request>& newest) {
    exert({});
    if (newest) {
      newest->force_n = {};
    }
  }
  static std::optional<wire::Request> request_in(std::string_view bytes) {
    wire::Request request;
    if (bytes.size() != sizeof request) {
      return std::nullopt;
    }
    std::memcpy(&request, bytes.data(), sizeof request);
    const bool is_known =
        request.asked == wire::Asked::exchange || request.asked == wire::Asked::introduction;
    const bool is_finite =
        std::ranges::all_of(request.force_n, [](double n) { return std::isfinite(n); });
    return request.mark == wire::Request::expected_mark && is_known && is_finite
               ? std::optional{request}
               : std::nullopt;
  }
  // Datagrams that arrived before the socket was connected may be of anybody.
  bool is_next(const sockaddr_in& from, std::uint32_t number) const {
    return !has_sender_ || (from.sin_port == sender_.sin_port && number > number_);
  }
  // The kernel keeps other senders' datagrams away from a connected socket.
  void listen_to(const sockaddr_in& from) {
    note_silence();  // before the first request after it
    if (!has_sender_) {
      connect(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof from);
      has_sender_ = true;
      sender_ = from;
    }
    heard_at_ = Clock::now();
  }
  void note_silence() {
    const auto silent = Clock::now() - heard_at_;
    if (silent > max_silence && !has_released_) {
      has_released_ = true;
      exert({});
    }
    if (silent > until_forgotten && has_sender_) {
      sockaddr nobody{};
      nobody.sa_family = AF_UNSPEC;
      connect(socket_, &nobody, sizeof nobody);
      has_sender_ = false;
    }
  }
  // Scaled down to what the device may exert.
  void exert(wire::Vector force_n) {
    const double size_n = std::hypot(force_n[0], force_n[1], force_n[2]);
    for (double& part_n : force_n) {
      part_n *= size_n > introduction_.max_force_n ? introduction_.max_force_n / size_n : 1.0;
    }
    device_.exert(force_n);
  }
  void obey(const wire::Request& request) {
    if (request.asked == wire::Asked::introduction) {
      exert({});
      introduction_.request = number_;
      send(socket_, &introduction_, sizeof introduction_, 0);
    } else {
      exert(is_usable_ ? request.force_n : wire::Vector{});
      reply();
    }
  }
  void reply() {
    wire::Reply reply;
    device_.sample(reply);
    reply.request = number_;
    const bool is_placed =
        std::ranges::all_of(reply.position_m, [](double m) { return std::isfinite(m); });
    if (!is_placed || !(reply.age_s <= max_sample_age_s)) {
      reply.status &= ~wire::motors_on;
      if (reply.text[0] == '\0') {
        put_text(reply.text,
                 is_placed ? "no samples from the device" : "the device tells no position");
      }
    }
    is_usable_ = (reply.status & wire::motors_on) != 0;
    if (!is_usable_) {
      exert({});
    }
    reply.status |= has_released_ ? wire::force_was_released : 0;
    has_released_ = false;
    send(socket_, &reply, sizeof reply, 0);
  }

  Device& device_;
  wire::Introduction introduction_;
  int socket_;
  sockaddr_in sender_{};
  bool has_sender_ = false;
  bool has_released_ = true;
  bool is_usable_ = true;  // the device, at its last sample: else not even a moment's force
  Clock::time_point heard_at_ = Clock::now();
  Clock::time_point empty_at_ = Clock::now();  // the socket's queue, the last time
  std::uint32_t number_ = 0;
};
}  // namespace bridge
// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
