#pragma once
#include <fstream>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
namespace tapstudy::core {
// A file that could not be written whole, as on a full disk: nothing is wrong with the input.
class WritingFailed : public Error {
 public:
  explicit WritingFailed(const std::string& file)
      : Error{file + ": writing failed (is the disk full?)"} {}
};

// Writes to a file or pipe; false on failure, with errno.
bool write_all(int descriptor, std::string_view bytes);
// Flushes a directory's entries to the disk, which POSIX asks for where a file in it was made or
// renamed and is to survive a power cut. Where a file system cannot, it needs none.
void flush_directory(const std::string& directory);

using Write = std::function<void(std::ostream&)>;
// Throws InvalidInput if the file already exists or its directory does not: to be called before a
// long computation.
void check_is_new(const std::string& file);
// Creates a file and writes it by the function. Throws InvalidInput if the file already exists or
// cannot be created, and WritingFailed if it could not be written completely.
void write_new_file(const std::string& file, const Write& write);
void write_new_file(const std::string& file, const std::string& text);

struct NewFile {
  std::string name;
  std::string text;
};
enum class Existing { kept, replaced };
// Writes files that belong together: all are on the disk before any appears under its name. Makes
// the folders that they need. Throws InvalidInput, and leaves what was there and no more, if one
// exists and is to be kept, is not a regular file, or cannot be created; WritingFailed if it cannot
// be written. Only where whole files cannot be renamed, those renamed before stay. Two of one name
// are a defect: std::logic_error.
void write_all_or_none(const std::vector<NewFile>& files, Existing existing);

// Makes the directory, and those above it, where they are not there. Throws InvalidInput if it
// cannot be made or nothing can be written into it.
void make_directories(const std::string& directory);
// Makes a new directory all at once: `fill` writes into an unfinished one beside it, given its
// name, which gets the final name when everything is in it. The remains of a killed program are
// called NAME.unfinished-…; the next one removes them. Throws InvalidInput, and leaves nothing, if
// there is something of that name already or it cannot be made; and what `fill` throws.
void write_new_directory(const std::string& directory,
                         const std::function<void(const std::string& unfinished)>& fill);
// The same for a single file, which `fill` creates under the name that it is given.
void write_new_file_by(const std::string& file,
                       const std::function<void(const std::string& unfinished)>& fill);
}  // namespace tapstudy::core
