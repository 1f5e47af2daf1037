#include "results/server/assigned_rows.hpp"

#include <fmt/format.h>

#include "results/server/server_schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
// Order 0 is row 1. Of a participant who was pushed, or who was given one.
constexpr const char* own_row_sql = R"sql(
SELECT row FROM tapstudy.assigned_row
  WHERE protocol_sha256 = $1 AND site = $2 AND participant_id = $3
UNION ALL
SELECT order_index + 1 FROM tapstudy.participant JOIN tapstudy.store USING (store_id)
  WHERE protocol_sha256 = $1 AND site = $2 AND participant_id = $3 AND mode = 'real'
LIMIT 1
)sql";

constexpr const char* next_row_sql = R"sql(
INSERT INTO tapstudy.assigned_row (protocol_sha256, row, site, participant_id, title)
SELECT $1, 1 + coalesce(max(taken), 0), $2, $3, $4 FROM (
  SELECT row AS taken FROM tapstudy.assigned_row WHERE protocol_sha256 = $1
  UNION ALL
  SELECT order_index + 1 FROM tapstudy.participant JOIN tapstudy.store USING (store_id)
    WHERE protocol_sha256 = $1 AND mode = 'real') AS all_taken
RETURNING row
)sql";

constexpr const char* other_text_sql = R"sql(
SELECT protocol_sha256 FROM tapstudy.store WHERE title = $2 AND protocol_sha256 <> $1
UNION ALL
SELECT protocol_sha256 FROM tapstudy.assigned_row WHERE title = $2 AND protocol_sha256 <> $1
LIMIT 1
)sql";
constexpr const char* namesake_sql = R"sql(
SELECT site, participant_id FROM (
  SELECT protocol_sha256, site, participant_id FROM tapstudy.assigned_row
  UNION ALL
  SELECT protocol_sha256, site, participant_id
    FROM tapstudy.participant JOIN tapstudy.store USING (store_id)) AS all_named
  WHERE protocol_sha256 = $1 AND lower(participant_id) = lower($3)
    AND (site <> $2 OR participant_id <> $3)
LIMIT 1
)sql";
}  // namespace

int assigned_row(const StudyOfServer& study, const std::string& site,
                 const std::string& participant_id, ServerConnection& server) {
  check_server_schema(server);
  ServerTransaction all{server};
  server.rows("SELECT pg_advisory_xact_lock(hashtext('tapstudy.assigned_row'), hashtext($1))",
              {study.title});
  const auto other = server.rows(other_text_sql, {study.protocol_sha256, study.title});
  if (!other.empty()) {
    throw StoreError{
        fmt::format("{}: '{}' is there with another text of the protocol (SHA-256 {}…); where a "
                    "study has begun "
                    "its directory says which text is meant",
                    server.name(), study.title, other[0][0].value().substr(0, 8))};
  }
  std::vector<std::string> who{study.protocol_sha256, site, participant_id};
  const auto namesake = server.rows(namesake_sql, who);
  if (!namesake.empty()) {
    throw StoreError{fmt::format(
        "{}: {} has a participant {}: ids differ among the sites of a study, and by more than "
        "letter case",
        server.name(), namesake[0][0].value(), namesake[0][1].value())};
  }
  auto row = server.rows(own_row_sql, who);
  if (row.empty()) {
    who.push_back(study.title);
    row = server.rows(next_row_sql, who);
  }
  all.commit();
  return std::stoi(row.at(0).at(0).value());
}
}  // namespace tapstudy::results
