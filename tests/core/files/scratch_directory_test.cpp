// Directories for temporary files.
#include "core/files/scratch_directory.hpp"

#include <filesystem>
#include <fstream>
#include <optional>

#include "support/catch.hpp"
using namespace tapstudy;
namespace fs = std::filesystem;

TEST_CASE("a scratch directory is new, its owner's alone, and leaves nothing", "[core][files]") {
  std::optional<core::ScratchDirectory> first{std::in_place};
  const core::ScratchDirectory second;
  CHECK(first->path() != second.path());
  CHECK(fs::status(first->path()).permissions() == fs::perms::owner_all);
  const fs::path path = first->path();
  fs::create_directory(path / "folder");
  std::ofstream{path / "folder" / "file"} << "text";
  REQUIRE(fs::exists(path / "folder" / "file"));
  first.reset();
  CHECK_FALSE(fs::exists(path));
  CHECK(fs::is_empty(second.path()));
}
