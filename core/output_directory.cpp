#include "core/output_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.hpp"
#include "core/output_file.hpp"
namespace tapstudy::core {
namespace {
namespace fs = std::filesystem;

// "out/" is the directory "out".
std::string without_slash(std::string directory) {
  while (directory.size() > 1 && directory.back() == '/') {
    directory.pop_back();
  }
  return directory;
}

// Removed with all that is in it, unless it has been renamed.
class Unfinished {
 public:
  explicit Unfinished(const std::string& final_name) {
    std::error_code error;
    bool is_made = false;
    for (int i = 0; !is_made && !error; ++i) {  // what a killed program left stays as it is
      name_ = fmt::format("{}.unfinished-{}-{}", final_name, getpid(), i);
      is_made = fs::create_directory(name_, error);
    }
    if (error) {
      throw InvalidInput{final_name + ": cannot be made: " + error.message()};
    }
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
};

void rename_to_new(const std::string& from, const std::string& to) {
  check_is_new(to);  // a rename would replace a file, and an empty directory
  std::error_code error;
  fs::rename(from, to, error);
  if (error) {
    throw InvalidInput{to + ": cannot be made: " + error.message()};
  }
}
}  // namespace

void make_directories(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw InvalidInput{fmt::format("{}: cannot be made: {}", directory, error.message())};
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
