#include "core/files/output_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>

#include "core/error.hpp"
namespace tapstudy::core {
void flush_directory(const std::string& directory) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
  const int descriptor = open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) {
      return false;
    }
    bytes.remove_prefix(count > 0 ? static_cast<std::size_t>(count) : 0);
  }
  return true;
}

namespace {
namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const std::string& what, std::error_code error) {
  if (error == std::errc::no_space_on_device || error.value() == EDQUOT) {
    throw WritingFailed{file};
  }
  throw InvalidInput{fmt::format("{}: {}: {}", file, what, error.message())};
}

// A file that did not exist before, and will not again unless it is kept.
class CreatedFile {
 public:
  explicit CreatedFile(const std::string& file)
      : name_{file},
        descriptor_{open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)} {
    if (descriptor_ < 0) {
      refuse(file, "cannot be written", {errno, std::generic_category()});
    }
  }
  ~CreatedFile() {
    close(descriptor_);
    if (!is_kept_) {
      std::error_code ignored;
      fs::remove(name_, ignored);
    }
  }
  CreatedFile(const CreatedFile&) = delete;
  CreatedFile& operator=(const CreatedFile&) = delete;
  CreatedFile(CreatedFile&&) = delete;
  CreatedFile& operator=(CreatedFile&&) = delete;

  void write(const Write& write) {
    std::ofstream stream{name_, std::ios::binary};
    write(stream);
    stream.close();
    check(!stream.fail());
  }
  void sync() const { check(fsync(descriptor_) == 0); }
  void keep() { is_kept_ = true; }

 private:
  void check(bool is_written) const {
    if (!is_written) {
      throw WritingFailed{name_};
    }
  }

  std::string name_;
  int descriptor_;
  bool is_kept_{false};
};

void check_is_replaceable(const std::string& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  if (type != fs::file_type::not_found && type != fs::file_type::regular) {
    throw InvalidInput{file + ": is not a regular file and is not replaced"};
  }
}

void check_names_differ(const std::vector<NewFile>& files) {
  std::set<std::string> names;
  for (const NewFile& file : files) {
    if (!names.insert(file.name).second) {
      throw std::logic_error{file.name + ": two files of one name"};
    }
  }
}

std::string unfinished(const std::string& file) {
  return file + ".unfinished";
}

void write_unfinished(const NewFile& file) {
  std::error_code ignored;
  fs::remove(unfinished(file.name), ignored);  // of a program that was killed
  CreatedFile created{unfinished(file.name)};
  created.write([&](std::ostream& out) { out << file.text; });
  created.sync();
  created.keep();
}

// The folders that were not there before.
class CreatedDirectories {
 public:
  void make_for(const std::string& file) {
    const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path at = folder; !fs::exists(at, error) && at != at.root_path();
         at = at.parent_path()) {
      missing.push_back(at);
    }
    std::ranges::reverse(missing);
    for (const fs::path& at : missing) {
      fs::create_directory(at, error);
      if (error) {
        refuse(at.string(), "cannot be made a directory", error);
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
    refuse(file, "cannot be replaced", error);
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
  CreatedFile created{file};
  created.write(write);
  created.keep();
}

void write_new_file(const std::string& file, const std::string& text) {
  write_new_file(file, [&](std::ostream& out) { out << text; });
}

void write_all_or_none(const std::vector<NewFile>& files, Existing existing) {
  check_names_differ(files);
  CreatedDirectories folders;
  try {
    std::ranges::for_each(files, [&](const NewFile& file) { folders.make_for(file.name); });
    std::ranges::for_each(files, existing == Existing::kept ? check_is_new : check_is_replaceable,
                          &NewFile::name);
    std::ranges::for_each(files, write_unfinished);
    std::ranges::for_each(files, finish, &NewFile::name);
  } catch (...) {
    for (const NewFile& file : files) {
      std::error_code ignored;
      fs::remove(unfinished(file.name), ignored);
    }
    folders.remove();
    throw;
  }
}

namespace {
namespace fs = std::filesystem;

// "out/" is the directory "out".
std::string without_slash(std::string directory) {
  while (directory.size() > 1 && directory.back() == '/') {
    directory.pop_back();
  }
  return directory;
}

// Locked for as long as the program that fills it lives: the lock of one that was killed is gone.
class LockedDirectory {
 public:
  explicit LockedDirectory(const std::string& name)
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
      : descriptor_{open(name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)},
        is_locked_{descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) == 0} {}
  ~LockedDirectory() {
    if (descriptor_ >= 0) {
      close(descriptor_);
    }
  }
  LockedDirectory(const LockedDirectory&) = delete;
  LockedDirectory& operator=(const LockedDirectory&) = delete;
  LockedDirectory(LockedDirectory&&) = delete;
  LockedDirectory& operator=(LockedDirectory&&) = delete;
  bool is_locked() const { return is_locked_; }

 private:
  int descriptor_;
  bool is_locked_;
};

// "NAME.unfinished-PID-N", and nothing else that may begin so.
bool is_unfinished_of(const std::string& file, const std::string& final_name) {
  const std::string prefix = fs::path{final_name}.filename().string() + ".unfinished-";
  constexpr std::string_view allowed = "0123456789-";
  return file.starts_with(prefix) && file.size() > prefix.size() &&
         file.find_first_not_of(allowed, prefix.size()) == std::string::npos;
}

// Where the file system knows no locks, they stay: nobody can tell whether they are still filled.
void remove_what_killed_programs_left(const std::string& final_name) {
  std::error_code error;
  std::vector<fs::path> left;
  for (fs::directory_iterator at{fs::absolute(final_name).parent_path(), error}, end;
       !error && at != end; at.increment(error)) {
    if (is_unfinished_of(at->path().filename().string(), final_name)) {
      left.push_back(at->path());
    }
  }
  for (const fs::path& directory : left) {
    if (const LockedDirectory lock{directory.string()}; lock.is_locked()) {
      fs::remove_all(directory, error);
    }
  }
}

// Removed with all that is in it, unless it has been renamed.
class Unfinished {
 public:
  explicit Unfinished(const std::string& final_name) {
    remove_what_killed_programs_left(final_name);
    std::error_code error;
    bool is_made = false;
    for (int i = 0; !is_made && !error; ++i) {
      name_ = fmt::format("{}.unfinished-{}-{}", final_name, getpid(), i);
      is_made = fs::create_directory(name_, error);
    }
    if (error) {
      refuse(final_name, "cannot be made", error);
    }
    lock_.emplace(name_);
  }
  ~Unfinished() {
    std::error_code ignored;
    fs::remove_all(name_, ignored);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  Unfinished(Unfinished&&) = delete;
  Unfinished& operator=(Unfinished&&) = delete;
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::optional<LockedDirectory> lock_;
};

void rename_to_new(const std::string& from, const std::string& to) {
  check_is_new(to);  // a rename would replace a file, and an empty directory
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    refuse(to, "cannot be made", error);
  }
}
}  // namespace

void make_directories(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    refuse(directory, "cannot be made", error);
  }
  if (!fs::is_directory(directory, error) || access(directory.c_str(), W_OK | X_OK) != 0) {
    throw InvalidInput{directory + ": is not a writable directory"};
  }
}

void write_new_directory(const std::string& directory,
                         const std::function<void(const std::string& unfinished)>& fill) {
  const std::string final_name = without_slash(directory);
  check_is_new(final_name);
  const Unfinished unfinished{final_name};
  fill(unfinished.name());
  rename_to_new(unfinished.name(), final_name);
}

void write_new_file_by(const std::string& file,
                       const std::function<void(const std::string& unfinished)>& fill) {
  check_is_new(file);
  const Unfinished beside{file};
  const std::string unfinished = (fs::path{beside.name()} / fs::path{file}.filename()).string();
  fill(unfinished);
  rename_to_new(unfinished, file);
}
}  // namespace tapstudy::core
