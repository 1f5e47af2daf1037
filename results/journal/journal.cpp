#include "results/journal/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "core/files/output_files.hpp"
#include "core/files/sha256.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
StoreError failure(const std::string& file, const char* what) {
  return StoreError{fmt::format("{}: {}: {}", file, what, std::strerror(errno))};
}

// Open and locked for as long as this lives.
class LockedFile {
 public:
  explicit LockedFile(const std::string& file)
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
      : descriptor_{open(file.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0644)} {
    if (descriptor_ < 0) {
      throw failure(file, "cannot be written");
    }
    int locked = flock(descriptor_, LOCK_EX);
    while (locked != 0 && errno == EINTR) {
      locked = flock(descriptor_, LOCK_EX);
    }
    if (locked != 0) {
      const StoreError error =
          failure(file, "cannot be locked (a study belongs on a disk of this machine)");
      close(descriptor_);
      throw error;
    }
  }
  ~LockedFile() { close(descriptor_); }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  LockedFile(LockedFile&&) = delete;
  LockedFile& operator=(LockedFile&&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

// The bytes from `begin` to the file's end.
std::string read_from(int descriptor, std::int64_t begin, const std::string& file) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) {
    throw failure(file, "cannot be read");
  }
  std::string text(static_cast<std::size_t>(std::max<std::int64_t>(status.st_size - begin, 0)),
                   '\0');
  if (pread(descriptor, text.data(), text.size(), begin) != static_cast<ssize_t>(text.size())) {
    throw failure(file, "cannot be read");
  }
  return text;
}
}  // namespace

std::string journal_file(const std::string& directory) {
  return (std::filesystem::path{directory} / "answers.journal").string();
}

void Journal::flush() {
  const LockedFile file{file_};
  flush(file.descriptor());
}

// A kernel that could not write a page says so once and takes it for written from then on: only
// what is written again after a failure is flushed by the next fsync.
void Journal::flush(int descriptor) {
  if (flush_failed_) {
    write_again(descriptor);
  }
  if (fsync(descriptor) != 0) {
    flush_failed_ = true;
    throw failure(file_, "writing failed");
  }
  if (flushed_bytes_ == 0) {  // this program may have made it
    core::flush_directory(std::filesystem::path{file_}.parent_path().string());
  }
  flush_failed_ = false;
  flushed_bytes_ = read_bytes_;
}

// In place: a program killed meanwhile takes nothing away.
void Journal::write_again(int descriptor) {
  const std::string text = read_from(descriptor, flushed_bytes_, file_);
  const bool appends = fcntl(descriptor, F_SETFL, 0) != 0;  // NOLINT: the way of the C library
  if (appends || pwrite(descriptor, text.data(), text.size(), flushed_bytes_) !=
                     static_cast<ssize_t>(text.size())) {
    throw failure(file_, "writing failed");
  }
}

// Reads the lines that other programs have appended since. Half a line at the end is cut off.
bool Journal::read_appended(int descriptor) {
  struct stat status {};
  fstat(descriptor, &status);
  const bool is_the_same = status.st_size >= read_bytes_;
  if (!is_the_same) {
    known_.clear();
    session_ids_.clear();
    chain_.clear();
    read_bytes_ = 0;
    flushed_bytes_ = 0;
  }
  const std::string text = read_from(descriptor, read_bytes_, file_);
  std::size_t begin = 0;
  for (auto end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    const JournalLine line = split_line(text.substr(begin, end - begin));
    known_.insert(line.body);
    chain_ = line.chain;
    begin = end + 1;
  }
  read_bytes_ += static_cast<std::int64_t>(begin);
  if (begin < text.size() && ftruncate(descriptor, read_bytes_) != 0) {
    throw failure(file_, "cannot be written");
  }
  return is_the_same;
}

std::string Journal::chained(const std::string& body) {
  chain_ = chain_of(chain_, body);
  return join_line({body, chain_}) + "\n";
}

bool Journal::complete(const std::function<StudyRow()>& study,
                       const std::vector<SessionRow>& sessions, const JournalEntries& entries) {
  const LockedFile file{file_};
  if (!read_appended(file.descriptor())) {
    return false;
  }
  std::vector<std::string> bodies;
  if (known_.empty()) {
    bodies.push_back(to_line(study()));
  }
  for (const SessionRow& session : sessions) {
    bodies.push_back(to_line(session));
  }
  std::ranges::move(to_lines(entries), std::back_inserter(bodies));
  std::erase_if(bodies, [this](const std::string& body) { return known_.contains(body); });
  const std::string chain_before = chain_;
  std::string text;
  for (const std::string& body : bodies) {
    text += chained(body);
  }
  if (!core::write_all(file.descriptor(), text)) {
    const StoreError error = failure(file_, "writing failed");
    chain_ = chain_before;
    static_cast<void>(!ftruncate(file.descriptor(), read_bytes_));  // else cut off when read next
    throw error;
  }
  known_.insert(bodies.begin(), bodies.end());
  for (const SessionRow& session : sessions) {
    session_ids_.insert(session.id);
  }
  read_bytes_ += static_cast<std::int64_t>(text.size());
  // also lines of a program that was killed, or whose disk failed, before it had flushed them
  if (flush_ == Flush::each_time && flushed_bytes_ < read_bytes_) {
    flush(file.descriptor());
  }
  return true;
}
}  // namespace tapstudy::results
