// Files that belong together appear together or not at all.
#include "core/files/output_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

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

TEST_CASE("what killed programs left of a directory is removed by the next, and nothing else",
          "[core][output]") {
  const testing::TempDirectory directory;
  for (const char* const name : {"out.unfinished-1-0", "out.unfinished-2-0", "out.unfinished-notes",
                                 "other.unfinished-1-0"}) {
    fs::create_directory(directory / name);
    testing::write(fs::path{directory / name} / "half", "half");
  }
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
  const int filled = open((directory / "out.unfinished-2-0").c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(flock(filled, LOCK_EX) == 0);  // by a program that runs
  core::write_new_directory(directory / "out", [](const std::string& unfinished) {
    testing::write(unfinished + "/whole", "whole");
  });
  close(filled);
  CHECK(fs::exists(directory / "out/whole"));
  CHECK_FALSE(fs::exists(directory / "out.unfinished-1-0"));
  CHECK(fs::exists(directory / "out.unfinished-2-0"));
  CHECK(fs::exists(directory / "out.unfinished-notes"));
  CHECK(fs::exists(directory / "other.unfinished-1-0"));
  CHECK(testing::entries(directory.path()) == 4);
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
