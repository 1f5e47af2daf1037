#include "support/texts.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
namespace tapstudy::testing {
namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream stream{file, std::ios::binary};
  INFO(file.string());
  REQUIRE(stream.good());
  return {std::istreambuf_iterator<char>{stream}, {}};
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream stream{file, std::ios::binary};
  stream << text;
  REQUIRE(stream.flush().good());
}

std::string source(const std::string& name) {
  return (fs::path{source_directory()} / name).string();
}

fs::path shipped(const std::string& name) {
  return fs::path{source_directory()} / "protocols" / name;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  INFO("looking for: " << from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TempDirectory::TempDirectory() {
  std::string name = (fs::temp_directory_path() / "tapstudy_XXXXXX").string();
  REQUIRE(mkdtemp(name.data()) != nullptr);
  path_ = name;
}
TempDirectory::~TempDirectory() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::size_t entries(const std::string& directory) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator{directory},
                                                std::filesystem::directory_iterator{}));
}
}  // namespace tapstudy::testing
