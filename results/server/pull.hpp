#pragma once
#include <string>
#include <vector>

#include "results/server/server_connection.hpp"
namespace tapstudy::results {
// A study directory whose rows a server has.
struct ServedStore {
  std::string id;  // the server's number
  std::string site;
  std::string title;
  std::string protocol_sha256;
};

// All stores of one study on the server, by site and age. study: its title, or how the SHA-256 of
// its protocol begins; empty: the only one that there is. Throws StoreError as
// check_server_schema, and InvalidInput, naming those that there are, if it is none or several.
std::vector<ServedStore> stores_of_study(ServerConnection& server, const std::string& study);

// What its directory is called among those of its study: its site and the server's number.
std::string name_of_directory(const ServedStore& store);

// Writes the store as it was at the end of its last push into a directory without a study: the same
// rows, and the journal made from them. Throws StoreError if they are not what was pushed.
void pull_store(const ServedStore& store, ServerConnection& server, const std::string& directory);
}  // namespace tapstudy::results
