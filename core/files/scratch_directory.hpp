#pragma once
#include <string>
namespace tapstudy::core {
// A new directory among the system's temporary files, for its owner alone; RAII: removed with all
// that it holds.
class ScratchDirectory {
 public:
  // Throws InvalidInput if it cannot be made.
  ScratchDirectory();
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ScratchDirectory(ScratchDirectory&&) = delete;
  ScratchDirectory& operator=(ScratchDirectory&&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};
}  // namespace tapstudy::core
