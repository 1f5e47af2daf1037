#pragma once
#include <fstream>
#include <functional>
#include <ostream>
#include <string>
namespace tapstudy::core {
using Write = std::function<void(std::ostream&)>;
// Throws InvalidInput if there is something of that name, or no directory for it: to be asked
// before long work.
void check_is_new(const std::string& file);
// Writes a new file by the function. Throws InvalidInput if there is one of that name already, if
// it cannot be created, or if not everything arrived on the disk.
void write_new_file(const std::string& file, const Write& write);
// The same, but takes the place of a file of that name once everything is on the disk.
void replace_file(const std::string& file, const Write& write);
}  // namespace tapstudy::core
