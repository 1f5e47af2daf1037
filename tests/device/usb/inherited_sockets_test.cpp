#include "device/usb/inherited_sockets.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>

#include "support/catch.hpp"
using namespace tapstudy;

namespace {
// A listening socket; -1 if the port is taken. port 0: any.
int listening_at(std::uint16_t port) {
  const int descriptor = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto generic = std::bit_cast<sockaddr>(address);
  if (bind(descriptor, &generic, sizeof generic) != 0 || listen(descriptor, 1) != 0) {
    close(descriptor);
    return -1;
  }
  return descriptor;
}
std::uint16_t port_of(int descriptor) {
  sockaddr generic{};
  socklen_t size = sizeof generic;
  REQUIRE(getsockname(descriptor, &generic, &size) == 0);
  return ntohs(std::bit_cast<sockaddr_in>(generic).sin_port);
}
}  // namespace

TEST_CASE("a child that outlives its program does not keep the port that it inherited",
          "[device][safety]") {
  const int listening = listening_at(0);
  const std::uint16_t port = port_of(listening);
  std::array<int, 2> closed{};
  REQUIRE(pipe(closed.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    device::close_named_sockets();
    static_cast<void>(!write(closed[1], "c", 1));  // the pipe is no socket, and stays
    pause();
    _exit(0);
  }
  char byte = 0;
  REQUIRE(read(closed[0], &byte, 1) == 1);
  close(listening);
  const int again = listening_at(port);
  CHECK(again >= 0);
  close(again);
  kill(child, SIGKILL);
  CHECK(waitpid(child, nullptr, 0) == child);
  close(closed[0]);
  close(closed[1]);
}
