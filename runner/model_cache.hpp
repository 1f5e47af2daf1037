#pragma once
#include <optional>
#include <string>

#include "core/model/body_modes.hpp"
namespace tapstudy::runner {
// Solved bodies on disk, so that a study's models are solved once and not once a command. A file is
// written beside its place and then moved there, so that no other process ever sees half of one; it
// carries its own hash, and one that is torn or of another version counts as absent. Where there is
// no room or no permission, nothing is kept and a warning says so.
class ModelCache {
 public:
  // $TAPSTUDY_CACHE, else $XDG_CACHE_HOME/tapstudy, else ~/.cache/tapstudy; without any, no cache.
  static ModelCache of_this_user();
  // An empty directory name: no cache.
  explicit ModelCache(std::string directory) : directory_{std::move(directory)} {}

  std::optional<core::BodyModes> find(const std::string& key) const;
  void keep(const std::string& key, const core::BodyModes& modes) const;

 private:
  std::string file_of(const std::string& key) const;
  std::string directory_;
};

// Bytes that hold the modes whole, and back; nothing if the bytes are not such.
std::string encoded(const core::BodyModes& modes);
std::optional<core::BodyModes> decoded(const std::string& bytes);
}  // namespace tapstudy::runner
