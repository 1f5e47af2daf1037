#include "runner/session/participant_lock.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.hpp"
namespace tapstudy::runner {
// A link and what it leads to are one study.
ParticipantLock::ParticipantLock(const std::string& directory, const std::string& participant_id)
    : lock_{std::filesystem::weakly_canonical(std::filesystem::absolute(directory)).string() + " " +
                participant_id,
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
