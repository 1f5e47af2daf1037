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
constexpr timeval max_silence{0, 100'000};

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
}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: bridge PORT\n", stderr);
    return 2;
  }
  const int descriptor = listening_socket(std::atoi(argv[1]));
  Finger finger;
  std::array<double, 3> force_n{};
  while (true) {
    std::array<char, 36> request{};
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t count = recvfrom(descriptor, request.data(), request.size(), 0,
                                   reinterpret_cast<sockaddr*>(&from), &from_size);
    if (count != 36 || std::memcmp(request.data(), "TAPS", 4) != 0) {
      force_n = {};  // timeout or foreign packet: release the force
      continue;
    }
    std::uint32_t kind = 0;
    std::memcpy(&kind, request.data() + 4, 4);
    std::memcpy(force_n.data(), request.data() + 12, 24);
    if (kind == 1) {
      finger.move(force_n);
      std::array<char, 60> reply{'T', 'A', 'P', 'R', 1};
      std::memcpy(reply.data() + 8, request.data() + 8, 4);
      std::memcpy(reply.data() + 12, finger.position_m.data(), 24);
      std::memcpy(reply.data() + 36, finger.velocity_m_s.data(), 24);
      sendto(descriptor, reply.data(), reply.size(), 0, reinterpret_cast<sockaddr*>(&from),
             from_size);
    }
  }
}
// NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
