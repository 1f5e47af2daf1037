#include "runner/terminal/session_lock.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>

#include "core/error.hpp"
#include "core/files/sha256.hpp"
namespace tapstudy::runner {
// An abstract socket name is not a file, so it cannot be left behind.
SessionLock::SessionLock(const std::string& what, const std::string& refusal)
    : socket_{socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "tapstudy " + core::sha256(what);
  std::ranges::copy(name, address.sun_path + 1);  // the first byte is zero
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): the way of the C library
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    const int error = errno;
    close(socket_);
    throw core::InvalidInput{
        error == EADDRINUSE
            ? refusal
            : fmt::format("cannot check for another running session: {}", std::strerror(error))};
  }
}

SessionLock::~SessionLock() {
  close(socket_);
}

namespace {
// A link and what it leads to are one study; "out/" and "out" are, before the directory is made,
// too.
std::string study_at(const std::string& directory) {
  namespace fs = std::filesystem;
  return fs::weakly_canonical(fs::absolute(directory) / "study.db").parent_path().string();
}
}  // namespace

ParticipantLock::ParticipantLock(const std::string& directory, const std::string& participant_id)
    : lock_{study_at(directory) + " " + participant_id,
            fmt::format("participant '{}' is in a session of this study right now, or what was "
                        "done in one is being amended",
                        participant_id)} {}

bool is_in_session(const std::string& directory, const std::string& participant_id) {
  try {
    const ParticipantLock lock{directory, participant_id};
    return false;
  } catch (const core::InvalidInput&) {
    return true;
  }
}
}  // namespace tapstudy::runner
