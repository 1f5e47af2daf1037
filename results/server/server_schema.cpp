#include "results/server/server_schema.hpp"

#include <fmt/format.h>

#include "results/store/schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
void check_server_schema(ServerConnection& server) {
  if (!server.rows("SELECT to_regclass('tapstudy.schema_version')").front().front()) {
    throw StoreError{server.name() +
                     ": has no tables of tapstudy's; `tapstudy schema postgresql` prints the SQL "
                     "that makes them"};
  }
  const auto version = server.rows("SELECT version FROM tapstudy.schema_version");
  if (version.size() != 1 || version.front().front() != std::to_string(schema_version)) {
    throw StoreError{
        fmt::format("{}: has tables of another version of tapstudy than this one, "
                    "whose stores have schema {}",
                    server.name(), schema_version)};
  }
}
}  // namespace tapstudy::results
