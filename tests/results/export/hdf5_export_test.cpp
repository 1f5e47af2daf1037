// A study as one HDF5 file.
#include <filesystem>

#include "support/built_paths.hpp"
#include "support/catch.hpp"
#include "support/messy_study.hpp"
using namespace tapstudy;
using Catch::Matchers::EndsWith;
using testing::TempDirectory;
namespace fs = std::filesystem;
namespace messy = testing::messy_study;

namespace {
testing::ProgramResult export_hdf5(const std::string& study, const std::string& out) {
  return testing::tapstudy({"export", study, "--format", "hdf5", "--out", out});
}
}  // namespace

TEST_CASE("h5py reads of an export what sqlite3 reads of the study, traces to the bit",
          "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  const auto exported = export_hdf5(study, directory / "out.h5");
  INFO(exported.standard_error);
  REQUIRE(exported.exit_code == 0);
  const auto read = testing::run_program({"/usr/bin/python3",
                                          testing::source("tests/results/export/hdf5_reader.py"),
                                          study, directory / "out.h5"});
  INFO(read.standard_error);
  CHECK(read.exit_code == 0);
  CHECK_THAT(read.standard_output, Contains("8 bytes a number"));
  CHECK(export_hdf5(study, directory / "again.h5").exit_code == 0);
  CHECK(testing::contents(directory / "out.h5") == testing::contents(directory / "again.h5"));
}

TEST_CASE("an HDF5 file is there whole or not at all", "[results][export]") {
  const TempDirectory directory;
  const std::string study = messy::make(directory);
  testing::write(directory / "there.h5", "mine");
  CHECK_THAT(export_hdf5(study, directory / "there.h5").standard_error, Contains("exists already"));
  CHECK(testing::contents(directory / "there.h5") == "mine");
  REQUIRE(export_hdf5(study, directory / "whole.h5").exit_code == 0);
  const auto whole = static_cast<int>(fs::file_size(directory / "whole.h5") / 512);
  for (const int blocks : {0, 10, 100, whole / 2, whole - 1}) {  // of 512 bytes: a full disk
    CAPTURE(blocks);
    const auto run = testing::run_program(
        {"/bin/sh", "-c",
         "{ (ulimit -f " + std::to_string(blocks) + "; exec \"$@\" 2>&1); echo code $?; } | cat",
         "sh", testing::tapstudy_program(), "export", study, "--format", "hdf5", "--out",
         directory / "out.h5"});
    CHECK_THAT(run.standard_output, Contains("out.h5") && EndsWith("code 2\n"));
    CHECK_THAT(run.standard_output, Contains("cannot be written") || Contains("disk full"));
    CHECK(testing::entries(directory.path()) == 3);
  }
}
