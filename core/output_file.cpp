#include "core/output_file.hpp"

#include <algorithm>
#include <filesystem>

#include "core/error.hpp"
namespace tapstudy::core {
namespace {
namespace fs = std::filesystem;

void write_file(const std::string& file, const Write& write) {
  std::ofstream stream{file, std::ios::binary};
  if (!stream) {
    throw InvalidInput{file + ": cannot be written"};
  }
  write(stream);
  stream.close();
  if (!stream) {
    std::error_code ignored;
    fs::remove(file, ignored);
    throw InvalidInput{file + ": writing failed (is the disk full?)"};
  }
}

std::string unfinished(const std::string& file) {
  return file + ".unfinished";
}

// The folders that were not there before.
class MadeFolders {
 public:
  void make_for(const std::string& file) {
    const fs::path folder = fs::absolute(file).parent_path();
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path at = folder; !fs::exists(at, error) && at != at.root_path();
         at = at.parent_path()) {
      missing.push_back(at);
    }
    std::ranges::reverse(missing);
    for (const fs::path& at : missing) {
      if (!fs::create_directory(at, error)) {
        throw InvalidInput{at.string() + ": cannot be made a directory: " + error.message()};
      }
      made_.push_back(at);
    }
  }
  void remove() const {
    std::error_code ignored;
    std::ranges::for_each(made_.rbegin(), made_.rend(),
                          [&](const fs::path& folder) { fs::remove(folder, ignored); });
  }

 private:
  std::vector<fs::path> made_;
};

void finish(const std::string& file) {
  std::error_code error;
  fs::rename(unfinished(file), file, error);
  if (error) {
    throw InvalidInput{file + ": cannot be replaced: " + error.message()};
  }
}
}  // namespace

void check_is_new(const std::string& file) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() != fs::file_type::not_found) {
    throw InvalidInput{file + ": exists already and is not overwritten"};
  }
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder, error)) {
    throw InvalidInput{file + ": cannot be written, there is no directory " + folder.string()};
  }
}

void write_new_file(const std::string& file, const Write& write) {
  check_is_new(file);
  write_file(file, write);
}

void write_new_file(const std::string& file, const std::string& text) {
  write_new_file(file, [&](std::ostream& out) { out << text; });
}

void replace_file(const std::string& file, const Write& write) {
  write_file(unfinished(file), write);
  finish(file);
}

void write_all_or_none(const std::vector<NewFile>& files, Existing existing) {
  MadeFolders folders;
  try {
    std::ranges::for_each(files, [&](const NewFile& file) { folders.make_for(file.name); });
    if (existing == Existing::kept) {
      std::ranges::for_each(files, check_is_new, &NewFile::name);
    }
    for (const NewFile& file : files) {
      write_file(unfinished(file.name), [&](std::ostream& out) { out << file.text; });
    }
  } catch (const InvalidInput&) {
    for (const NewFile& file : files) {
      std::error_code ignored;
      fs::remove(unfinished(file.name), ignored);
    }
    folders.remove();
    throw;
  }
  std::ranges::for_each(files, finish, &NewFile::name);
}
}  // namespace tapstudy::core
