#include "device/usb/inherited_sockets.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
namespace tapstudy::device {
namespace {
constexpr int max_descriptors = 1024;

bool is_named(int descriptor) noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the C library's
  if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return false;  // not a socket
  }
  if (address.ss_family == AF_UNIX) {
    return size > offsetof(sockaddr_un, sun_path);
  }
  int is_listening = 0;
  socklen_t flag_size = sizeof is_listening;
  return getsockopt(descriptor, SOL_SOCKET, SO_ACCEPTCONN, &is_listening, &flag_size) == 0 &&
         is_listening != 0;
}
}  // namespace

void close_named_sockets() noexcept {
  for (int descriptor = STDERR_FILENO + 1; descriptor < max_descriptors; ++descriptor) {
    if (is_named(descriptor)) {
      close(descriptor);
    }
  }
}
}  // namespace tapstudy::device
