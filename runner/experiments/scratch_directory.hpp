#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
namespace tapstudy::runner {
// For a simulated study of which only the results are kept. RAII: removed with all it holds.
class ScratchDirectory {
 public:
  explicit ScratchDirectory(std::uint64_t seed);
  ~ScratchDirectory();
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ScratchDirectory(ScratchDirectory&&) = delete;
  ScratchDirectory& operator=(ScratchDirectory&&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};
}  // namespace tapstudy::runner
