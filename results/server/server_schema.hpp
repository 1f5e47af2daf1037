#pragma once
#include <string>

#include "results/server/server_connection.hpp"
namespace tapstudy::results {
// The SQL that makes a server's tables and the two roles that use them, for its administrator.
std::string server_schema_sql();
// Throws StoreError where the server has no tables of tapstudy's, or those of another version.
void check_server_schema(ServerConnection& server);
}  // namespace tapstudy::results
