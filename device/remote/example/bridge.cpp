// How to connect any device to tapstudy: a separate program that replies to its datagrams. Copy
// this, and replace the finger below by calls to your device. It uses no tapstudy code; the wire
// format is documented in device/remote/packets.hpp.
//
//   bridge PORT    and in the rig   device: remote   remote: {port: PORT}
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): sockets take addresses in no other way
namespace {
constexpr double max_force_n = 5.0;
constexpr timeval max_silence{0, 20'000};     // then the force is let go
constexpr int silences_until_forgotten = 50;  // then another sender may begin

// A finger of 0.1 kg on a muscle that lets it tap twice a second, pushed by the force; y is up.
struct Finger {
  std::array<double, 3> position_m{0.0, 0.02, 0.0};
  std::array<double, 3> velocity_m_s{};
  double time_s = 0.0;
  void move(const std::array<double, 3>& force_n) {
    constexpr double step_s = 1e-3;
    time_s += step_s;
    const std::array<double, 3> aim_m{0.0, 0.01 + 0.012 * std::cos(4.0 * M_PI * time_s), 0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double pull_n = 400.0 * (aim_m[i] - position_m[i]) - 9.0 * velocity_m_s[i];
      velocity_m_s[i] += step_s * (pull_n + force_n[i]) / 0.1;
      position_m[i] += step_s * velocity_m_s[i];
    }
  }
};

int listening_socket(int port) {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &max_silence, sizeof max_silence);
  if (bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    std::perror("bind");
    std::exit(1);
  }
  return descriptor;
}

struct Request {
  std::uint32_t kind = 0;
  std::uint32_t number = 0;
  std::array<double, 3> force_n{};
};

// Scaled down to what the device may exert.
void limit(std::array<double, 3>& force_n) {
  const double size_n = std::hypot(force_n[0], force_n[1], force_n[2]);
  for (double& part_n : force_n) {
    part_n *= size_n > max_force_n ? max_force_n / size_n : 1.0;
  }
}

// False if it is none of ours, or not a force.
bool read_request(const std::array<char, 64>& bytes, ssize_t count, Request& request) {
  if (count != 36 || std::memcmp(bytes.data(), "TAPS", 4) != 0) {
    return false;
  }
  std::memcpy(&request.kind, bytes.data() + 4, 4);
  std::memcpy(&request.number, bytes.data() + 8, 4);
  std::memcpy(request.force_n.data(), bytes.data() + 12, 24);
  limit(request.force_n);
  return std::isfinite(request.force_n[0]) && std::isfinite(request.force_n[1]) &&
         std::isfinite(request.force_n[2]);
}

// One sender at a time: the kernel keeps other senders' datagrams away from a connected socket.
class Bridge {
 public:
  explicit Bridge(int port) : socket_{listening_socket(port)} {}

  void serve() {
    std::array<char, 64> bytes{};
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t count = recvfrom(socket_, bytes.data(), bytes.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &from_size);
    Request request;
    if (count < 0) {
      note_silence();
    } else if (read_request(bytes, count, request) && is_next(from, request.number)) {
      if (!has_sender_) {
        connect(socket_, reinterpret_cast<sockaddr*>(&from), from_size);
        has_sender_ = true;
        sender_ = from;
      }
      obey(request);
    }
  }

 private:
  void note_silence() {
    has_released_ = true;
    force_n_ = {};
    if (++silences_ == silences_until_forgotten && has_sender_) {
      sockaddr nobody{};
      nobody.sa_family = AF_UNSPEC;
      connect(socket_, &nobody, sizeof nobody);
      has_sender_ = false;
    }
  }
  // Datagrams that arrived before the socket was connected may be of anybody.
  bool is_next(const sockaddr_in& from, std::uint32_t number) const {
    return !has_sender_ || (from.sin_port == sender_.sin_port && number > number_);
  }
  void obey(const Request& request) {
    silences_ = 0;
    number_ = request.number;
    force_n_ = request.force_n;
    if (request.kind == 1) {
      finger_.move(force_n_);
      reply();
    }
  }
  void reply() {
    const std::uint32_t status = 1U | (has_released_ ? 2U : 0U);
    has_released_ = false;
    std::array<char, 88> reply{'T', 'A', 'P', 'R', 2};
    std::memcpy(reply.data() + 8, &number_, 4);
    std::memcpy(reply.data() + 12, finger_.position_m.data(), 24);
    std::memcpy(reply.data() + 36, finger_.velocity_m_s.data(), 24);
    std::memcpy(reply.data() + 60, &status, 4);
    std::memcpy(reply.data() + 64, force_n_.data(), 24);
    send(socket_, reply.data(), reply.size(), 0);
  }

  int socket_;
  sockaddr_in sender_{};
  bool has_sender_ = false;
  bool has_released_ = false;
  int silences_ = 0;
  std::uint32_t number_ = 0;
  std::array<double, 3> force_n_{};
  Finger finger_;
};
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: bridge PORT\n", stderr);
    return 2;
  }
  Bridge bridge{std::atoi(argv[1])};
  while (true) {
    bridge.serve();
  }
}
// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
