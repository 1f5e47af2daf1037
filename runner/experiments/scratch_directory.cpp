#include "runner/experiments/scratch_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
namespace tapstudy::runner {
ScratchDirectory::ScratchDirectory(std::uint64_t seed)
    : path_{std::filesystem::temp_directory_path() /
            fmt::format("tapstudy-{}-{:x}", ::getpid(), seed)} {}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}
}  // namespace tapstudy::runner
