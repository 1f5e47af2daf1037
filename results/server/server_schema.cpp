#include "results/server/server_schema.hpp"

#include <fmt/format.h>

#include "results/server/mirrored_tables.hpp"
#include "results/store/schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
std::string server_schema_sql() {
  std::string sql = fmt::format(
      R"sql(-- tapstudy's tables of a PostgreSQL server, and the roles that use them: psql -f FILE, once.
BEGIN;
CREATE SCHEMA tapstudy;
CREATE TABLE tapstudy.schema_version (version integer NOT NULL);
INSERT INTO tapstudy.schema_version VALUES ({});
-- One row a study directory: a site's name, and which of its studies.
CREATE TABLE tapstudy.store (
  store_id bigint GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
  site text NOT NULL,
  title text NOT NULL,
  protocol_sha256 text NOT NULL,
  created_utc text NOT NULL,
  UNIQUE (site, protocol_sha256, created_utc)
);
-- How far each table of a store is here: rows beyond are of a push that has not ended.
CREATE TABLE tapstudy.mirrored (
  store_id bigint NOT NULL REFERENCES tapstudy.store,
  table_name text NOT NULL,
  last_row_id bigint NOT NULL,
  sha256 text NOT NULL,
  PRIMARY KEY (store_id, table_name)
);
-- Which row of a study's balanced orders each participant of each site has.
CREATE TABLE tapstudy.assigned_row (
  protocol_sha256 text NOT NULL,
  title text NOT NULL,
  row integer NOT NULL,
  site text NOT NULL,
  participant_id text NOT NULL,
  assigned_utc timestamp NOT NULL DEFAULT (now() AT TIME ZONE 'utc'),
  PRIMARY KEY (protocol_sha256, row),
  UNIQUE (protocol_sha256, site, participant_id)
);
)sql",
      schema_version);
  for (const MirroredTable& table : mirrored_tables()) {
    sql += fmt::format(
        "CREATE TABLE tapstudy.{} (store_id bigint NOT NULL REFERENCES tapstudy.store, row_id "
        "bigint "
        "NOT NULL",
        table.name);
    sql += table.definitions() + ", PRIMARY KEY (store_id, row_id));\n";
  }
  sql += R"sql(-- A site adds rows and changes none, but for how far its pushes are. A reader reads.
DO $$ BEGIN
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'tapstudy_site') THEN
    CREATE ROLE tapstudy_site NOLOGIN;
  END IF;
  IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'tapstudy_reader') THEN
    CREATE ROLE tapstudy_reader NOLOGIN;
  END IF;
END $$;
GRANT USAGE ON SCHEMA tapstudy TO tapstudy_site, tapstudy_reader;
GRANT SELECT ON ALL TABLES IN SCHEMA tapstudy TO tapstudy_site, tapstudy_reader;
GRANT INSERT ON ALL TABLES IN SCHEMA tapstudy TO tapstudy_site;
REVOKE INSERT ON tapstudy.schema_version FROM tapstudy_site;
GRANT UPDATE ON tapstudy.mirrored TO tapstudy_site;
COMMIT;
)sql";
  return sql;
}

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
