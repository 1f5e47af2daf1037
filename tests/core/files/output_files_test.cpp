// Files that belong together appear together or not at all.
#include "core/files/output_files.hpp"

#include <filesystem>
#include <stdexcept>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
namespace fs = std::filesystem;

TEST_CASE("where one of several files cannot be written, the others stay as they were",
          "[core][output]") {
  const testing::TempDirectory directory;
  testing::write(directory / "a", "old");
  fs::create_directory(directory / "b");
  const std::vector<core::NewFile> files{{directory / "a", "new"}, {directory / "b", "new"}};
  CHECK_THROWS_WITH(core::write_all_or_none(files, core::Existing::replaced),
                    Contains("b: is not a regular file and is not replaced"));
  CHECK(testing::contents(directory / "a") == "old");
  CHECK(testing::entries(directory.path()) == 2);
  CHECK_THROWS_AS(core::write_all_or_none(files, core::Existing::kept), core::InvalidInput);
  CHECK(testing::entries(directory.path()) == 2);
}

TEST_CASE("files replace what was there, also what a killed program left", "[core][output]") {
  const testing::TempDirectory directory;
  testing::write(directory / "a", "old");
  testing::write(directory / "a.unfinished", "half");
  core::write_all_or_none({{directory / "a", "new"}, {directory / "in/./b", "new"}},
                          core::Existing::replaced);
  CHECK(testing::contents(directory / "a") == "new");
  CHECK(testing::contents(directory / "in/b") == "new");
  CHECK_FALSE(fs::exists(directory / "a.unfinished"));
  CHECK_THROWS_AS(core::write_all_or_none({{directory / "c", "1"}, {directory / "c", "2"}},
                                          core::Existing::replaced),
                  std::logic_error);
  CHECK_FALSE(fs::exists(directory / "c"));
}

TEST_CASE("a file whose writer fails is not left half written", "[core][output]") {
  const testing::TempDirectory directory;
  const auto fails = [](std::ostream& out) {
    out << "half";
    throw std::runtime_error{"no more"};
  };
  CHECK_THROWS_AS(core::write_new_file(directory / "a", fails), std::runtime_error);
  CHECK(testing::entries(directory.path()) == 0);
}
