#pragma once
#include <fstream>
#include <functional>
#include <ostream>
#include <string>
#include <vector>
namespace tapstudy::core {
using Write = std::function<void(std::ostream&)>;
// Throws InvalidInput if the file already exists or its directory does not: to be called before a
// long computation.
void check_is_new(const std::string& file);
// Creates a file and writes it by the function. Throws InvalidInput if the file already exists,
// cannot be created, or could not be written completely.
void write_new_file(const std::string& file, const Write& write);
void write_new_file(const std::string& file, const std::string& text);

struct NewFile {
  std::string name;
  std::string text;
};
enum class Existing { kept, replaced };
// Writes files that belong together: all are on the disk before any appears under its name. Makes
// the folders that they need. Throws InvalidInput, and leaves what was there and no more, if one
// exists and is to be kept, is not a regular file, or cannot be written. Only where whole files
// cannot be renamed, those renamed before stay. Two of one name are a defect: std::logic_error.
void write_all_or_none(const std::vector<NewFile>& files, Existing existing);
}  // namespace tapstudy::core
