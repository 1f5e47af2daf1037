#pragma once
#include <optional>
#include <string>
#include <utility>

#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// Solved bodies on disk, so that a study's models are solved once and not once per command. A file
// is written under a temporary name and then renamed, so that no other process sees a partial one;
// it carries its own hash, and a corrupt one or one of another version counts as absent.
class ModelCache {
 public:
  // An empty directory name disables the cache. The version is that of the program, since another
  // version may solve differently.
  ModelCache(std::string directory, std::string version)
      : directory_{std::move(directory)}, version_{std::move(version)} {}

  const std::string& directory() const { return directory_; }
  std::optional<BodyModes> find(const std::string& key) const;
  // False, and nothing is stored, if the disk is full or permission is denied.
  [[nodiscard]] bool store(const std::string& key, const BodyModes& modes) const;

 private:
  std::string full_key(const std::string& key) const;
  std::string file_of(const std::string& key) const;
  std::string directory_;
  std::string version_;
};

// Serialises the modes to bytes, and back; nullopt if the bytes are not valid.
std::string encoded(const BodyModes& modes);
std::optional<BodyModes> decoded(const std::string& bytes);
}  // namespace tapstudy::core
