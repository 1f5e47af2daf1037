#pragma once
#include <string>
#include <vector>

#include "results/server/server_connection.hpp"
namespace tapstudy::results {
// Writes the stores of one study, as they were at the end of the last push of each, into a folder
// of their own below the directory: the same rows, and the journal made from them. Returns the
// folders' names, by site and age. study: its title, or how the SHA-256 of its protocol begins;
// empty: the only one that there is. Throws InvalidInput, naming those that there are, if it is
// none or several; StoreError as check_server_schema, and if rows are not what was pushed.
std::vector<std::string> pull_study(ServerConnection& server, const std::string& study,
                                    const std::string& directory);
}  // namespace tapstudy::results
