// What a study's database is refused for.
#include <fmt/format.h>

#include <chrono>
#include <set>
#include <string>

#include "core/plain_text.hpp"
#include "results/schema.hpp"
#include "results/store.hpp"
#include "results/store_error.hpp"

namespace tapstudy::results {
bool Store::is_empty() {
  Statement tables{database_, "SELECT count(*) FROM sqlite_master"};
  tables.step();
  return tables.integer(0) == 0;
}

void Store::check_is_sound() {
  constexpr std::chrono::seconds limit{10};
  check_version();
  database_.limit_time(limit);
  check_schema();
  database_.lift_limit();  // the rest takes as long as the file is large
  Statement check{database_, "PRAGMA quick_check(1)"};
  if (!check.step() || check.text(0) != "ok") {
    throw StoreError{
        fmt::format("{}: is damaged: {} (keep a copy; the answers are in "
                    "answers.journal beside it, too)",
                    database_.file(), check.text(0))};
  }
}

// Triggers and views act in the name of whoever opens the database.
void Store::check_schema() {
  const auto objects_of = [](Database& database) {
    Statement row{database,
                  "SELECT type || ' ' || name || ' ' || tbl_name || ' ' || coalesce(sql, '') "
                  "FROM sqlite_schema ORDER BY 1"};
    std::set<std::string> objects;
    while (row.step()) {
      objects.insert(row.text(0));
    }
    return objects;
  };
  Database reference = Database::in_memory("the schema");
  reference.run(schema_sql);
  const std::set<std::string> known = objects_of(reference);
  const std::set<std::string> found = objects_of(database_);
  for (const std::string& object : found) {
    if (!known.contains(object)) {
      throw StoreError{fmt::format("{}: contains a schema object that is not tapstudy's: {}",
                                   database_.file(), core::cut_to(object, 80))};
    }
  }
  if (found.size() != known.size()) {
    throw StoreError{database_.file() + ": lacks some of tapstudy's tables"};
  }
}

void Store::check_version() {
  if (database_.pragma("application_id") != application_id) {
    throw StoreError{database_.file() + ": is not a tapstudy database"};
  }
  const std::int64_t version = database_.pragma("user_version");
  if (version != schema_version) {
    throw StoreError{fmt::format("{}: has schema {}, this program reads {}", database_.file(),
                                 version, schema_version)};
  }
}
}  // namespace tapstudy::results
