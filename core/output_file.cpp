#include "core/output_file.hpp"

#include <algorithm>
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

std::string unfinished(const std::string& file) {
  return file + ".unfinished";
}

void finish(const std::string& file) {
  std::error_code error;
  std::filesystem::rename(unfinished(file), file, error);
  if (error) {
    throw InvalidInput{file + ": cannot be replaced: " + error.message()};
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
  write_file(unfinished(file), write);
  finish(file);
}

void write_all_or_none(const std::vector<NewFile>& files, Existing existing) {
  if (existing == Existing::kept) {
    std::ranges::for_each(files, check_is_new, &NewFile::name);
  }
  try {
    for (const NewFile& file : files) {
      write_file(unfinished(file.name), [&](std::ostream& out) { out << file.text; });
    }
  } catch (const InvalidInput&) {
    for (const NewFile& file : files) {
      std::error_code ignored;
      std::filesystem::remove(unfinished(file.name), ignored);
    }
    throw;
  }
  std::ranges::for_each(files, finish, &NewFile::name);
}
}  // namespace tapstudy::core
