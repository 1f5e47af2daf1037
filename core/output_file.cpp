#include "core/output_file.hpp"

#include <filesystem>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
void write_file(const std::string& file, const Write& write) {
  std::ofstream stream{file, std::ios::binary};
  if (!stream) {
    throw InvalidInput{file + ": cannot be written"};
  }
  write(stream);
  stream.close();
  if (!stream) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw InvalidInput{file + ": writing failed (is the disk full?)"};
  }
}
}  // namespace

void check_is_new(const std::string& file) {
  std::error_code error;
  if (std::filesystem::symlink_status(file, error).type() !=
      std::filesystem::file_type::not_found) {
    throw InvalidInput{file + ": exists already and is not overwritten"};
  }
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    throw InvalidInput{file + ": cannot be written, there is no directory " + folder.string()};
  }
}

void write_new_file(const std::string& file, const Write& write) {
  check_is_new(file);
  write_file(file, write);
}

void replace_file(const std::string& file, const Write& write) {
  const std::string unfinished = file + ".unfinished";
  write_file(unfinished, write);
  std::error_code error;
  std::filesystem::rename(unfinished, file, error);
  if (error) {
    throw InvalidInput{file + ": cannot be replaced: " + error.message()};
  }
}
}  // namespace tapstudy::core
