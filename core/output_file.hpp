#pragma once
#include <fstream>
#include <functional>
#include <ostream>
#include <string>
namespace tapstudy::core {
using Write = std::function<void(std::ostream&)>;
// Throws InvalidInput if the file already exists or its directory does not: to be called before a
// long computation.
void check_is_new(const std::string& file);
// Creates a file and writes it by the function. Throws InvalidInput if the file already exists,
// cannot be created, or could not be written completely.
void write_new_file(const std::string& file, const Write& write);
// The same, but replaces an existing file once the new one is completely on disk.
void replace_file(const std::string& file, const Write& write);
}  // namespace tapstudy::core
