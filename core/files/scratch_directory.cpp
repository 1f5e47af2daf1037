#include "core/files/scratch_directory.hpp"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/error.hpp"
namespace tapstudy::core {
ScratchDirectory::ScratchDirectory() {
  std::error_code error;
  path_ = (std::filesystem::temp_directory_path(error) / "tapstudy-XXXXXX").string();
  if (error || mkdtemp(path_.data()) == nullptr) {
    throw InvalidInput{path_ + ": a directory for temporary files cannot be made"};
  }
}

ScratchDirectory::~ScratchDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}
}  // namespace tapstudy::core
