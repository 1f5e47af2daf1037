#pragma once
#include "results/server/server_connection.hpp"
namespace tapstudy::results {
// Throws StoreError where the server has no tables of tapstudy's, or those of another version.
void check_server_schema(ServerConnection& server);
}  // namespace tapstudy::results
