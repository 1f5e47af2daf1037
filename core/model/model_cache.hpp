#pragma once
#include <optional>
#include <string>
#include <utility>

#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// Solved bodies on disk, so that a study's models are solved once and not once a command. A file is
// written beside its place and then moved there, so that no other process ever sees half of one; it
// carries its own hash, and one that is torn or of another version counts as absent.
class ModelCache {
 public:
  // An empty directory name: no cache. The version is that of the program: another one may solve
  // otherwise.
  ModelCache(std::string directory, std::string version)
      : directory_{std::move(directory)}, version_{std::move(version)} {}

  const std::string& directory() const { return directory_; }
  std::optional<BodyModes> find(const std::string& key) const;
  // False if there is no room or no permission; then nothing is kept.
  [[nodiscard]] bool keep(const std::string& key, const BodyModes& modes) const;

 private:
  std::string full_key(const std::string& key) const;
  std::string file_of(const std::string& key) const;
  std::string directory_;
  std::string version_;
};

// Bytes that hold the modes whole, and back; nothing if the bytes are not such.
std::string encoded(const BodyModes& modes);
std::optional<BodyModes> decoded(const std::string& bytes);
}  // namespace tapstudy::core
