#pragma once
#include <filesystem>
#include <string>
namespace tapstudy::testing {
std::string contents(const std::filesystem::path& file);
void write(const std::filesystem::path& file, const std::string& text);
// A path below the sources, or below protocols/.
std::string source(const std::string& name);
std::filesystem::path shipped(const std::string& name);
// The first occurrence of `from` replaced; fails the test if there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

// A new empty directory, removed at the end of the scope.
class TempDirectory {
 public:
  TempDirectory();
  ~TempDirectory();
  TempDirectory(const TempDirectory& other) = delete;
  TempDirectory& operator=(const TempDirectory& other) = delete;
  std::string path() const { return path_.string(); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

std::size_t entries(const std::string& directory);  // in it, how many
}  // namespace tapstudy::testing
