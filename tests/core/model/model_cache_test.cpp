#include "core/model/model_cache.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/model/plate_model.hpp"
#include "support/catch.hpp"
#include "support/plates.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using core::ModelCache;

namespace {
core::BodyModes some_modes() {
  return core::solve_body(core::body_of(testing::paper_plate(2, testing::mdf()))).modes;
}
std::string only_file_in(const std::string& directory) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator{directory}) {
    files.push_back(entry.path().string());
  }
  REQUIRE(files.size() == 1);
  return files.front();
}
}  // namespace

TEST_CASE("what was kept is found to the last bit, under its own key only", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  const core::BodyModes modes = some_modes();
  CHECK_FALSE(cache.find("a plate"));
  CHECK(cache.keep("a plate", modes));
  const auto found = cache.find("a plate");
  REQUIRE(found);
  CHECK((found->kappa_rad_per_m == modes.kappa_rad_per_m).all());
  CHECK(found->band_limit_rad_per_m == modes.band_limit_rad_per_m);
  CHECK(found->shape == modes.shape);
  CHECK(found->touch_surface == modes.touch_surface);
  CHECK(found->touch_nodes_m == modes.touch_nodes_m);
  CHECK(found->report.dofs == modes.report.dofs);
  CHECK_FALSE(cache.find("another plate"));
  CHECK_FALSE(ModelCache{directory / "models", "2"}.find("a plate"));  // of another program
}

TEST_CASE("a torn or altered file counts as absent and is replaced", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  CHECK(cache.keep("a plate", some_modes()));
  const std::string file = only_file_in(directory / "models");
  const std::string whole = testing::contents(file);
  for (const std::size_t length : {std::size_t{0}, whole.size() / 2, whole.size() - 1}) {
    std::ofstream{file, std::ios::binary} << whole.substr(0, length);
    CHECK_FALSE(cache.find("a plate"));
  }
  std::string altered = whole;
  altered[whole.size() / 2] ^= 1;
  std::ofstream{file, std::ios::binary} << altered;
  CHECK_FALSE(cache.find("a plate"));
  CHECK(cache.keep("a plate", some_modes()));
  CHECK(cache.find("a plate"));
  only_file_in(directory / "models");
}

TEST_CASE("processes that keep and find at once find all or nothing", "[core][cache]") {
  const testing::TempDirectory directory;
  const ModelCache cache{directory / "models", "1"};
  const core::BodyModes modes = some_modes();
  const std::string kept = core::encoded(modes);
  std::vector<pid_t> children;
  for (int child = 0; child < 3; ++child) {
    children.push_back(fork());
    if (children.back() == 0) {
      bool is_whole = true;
      for (int turn = 0; turn < 200; ++turn) {
        const bool is_kept = cache.keep("a plate", modes);
        const auto found = cache.find("a plate");
        is_whole = is_whole && is_kept && found && core::encoded(*found) == kept;
      }
      _exit(is_whole ? 0 : 1);
    }
  }
  for (const pid_t child : children) {
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(status == 0);
  }
  only_file_in(directory / "models");
}

TEST_CASE("a cache without a place keeps nothing, and says so", "[core][cache]") {
  const ModelCache nowhere{"/proc/no/such/place", "1"};
  CHECK_FALSE(nowhere.keep("a plate", some_modes()));
  CHECK_FALSE(nowhere.find("a plate"));
}
