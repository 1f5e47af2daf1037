#pragma once
#include <functional>
#include <string>
namespace tapstudy::core {
// Makes the directory, and those above it, where they are not there. Throws InvalidInput if it
// cannot be made or nothing can be written into it.
void make_directories(const std::string& directory);
// Makes a new directory all at once: `fill` writes into an unfinished one beside it, given its
// name, which gets the final name when everything is in it. What remains of a killed program is
// called NAME.unfinished-… and never read.
// Throws InvalidInput, and leaves nothing, if there is something of that name already or it cannot
// be made; and what `fill` throws.
void write_new_directory(const std::string& directory,
                         const std::function<void(const std::string& unfinished)>& fill);
// The same for a single file, which `fill` creates under the name that it is given.
void write_new_file_by(const std::string& file,
                       const std::function<void(const std::string& unfinished)>& fill);
}  // namespace tapstudy::core
