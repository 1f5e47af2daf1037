#include "results/server/pull.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "results/server/mirrored_tables.hpp"
#include "results/server/server_schema.hpp"
#include "results/store/schema.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

// A study directory whose rows a server has.
struct ServedStore {
  std::string id;  // the server's number
  std::string site;
  std::string title;
  std::string protocol_sha256;
};

std::string insert_sql(const MirroredTable& table) {
  std::string values;
  const std::size_t count = table.columns.size() + (table.has_own_id ? 0 : 1);
  for (std::size_t i = 0; i < count; ++i) {
    values += i == 0 ? "?" : ", ?";
  }
  return fmt::format("INSERT INTO {} ({}{}) VALUES ({})", table.name,
                     table.has_own_id ? "" : "rowid, ", table.column_list(), values);
}

void pull_table(const ServedStore& store, const MirroredTable& table, ServerConnection& server,
                Database& database) {
  const auto mark = server.rows(
      "SELECT last_row_id, sha256 FROM tapstudy.mirrored WHERE store_id = $1 AND table_name = $2",
      {store.id, table.name});
  const std::string last_row = mark.at(0).at(0).value();
  const std::string sql = insert_sql(table);
  server.copy_out(fmt::format("COPY (SELECT row_id, {} FROM tapstudy.{} WHERE store_id = {} AND "
                              "row_id <= {} ORDER BY row_id) TO STDOUT",
                              table.column_list(), table.name, store.id, last_row),
                  [&](std::string_view line) {
                    Statement insert{database, sql};
                    bind_copy_line(table, line, insert);
                    insert.finish();
                  });
  std::string hash;
  Statement row{database, table.select()};
  while (row.step()) {
    hash = hash_after(hash, copy_line(table, row));
  }
  if (hash != mark[0][1]) {
    throw StoreError{fmt::format("{}: rows of {} of {} are not those that were pushed",
                                 server.name(), table.name, store.site)};
  }
}
// Those of one study, by site and age.
std::vector<ServedStore> stores_of_study(ServerConnection& server, const std::string& study) {
  check_server_schema(server);
  std::vector<ServedStore> found;
  std::map<std::string, std::string> titles;  // by hash
  // what no push has finished is left out
  for (const auto& row : server.rows(
           "SELECT store_id, site, title, protocol_sha256 FROM tapstudy.store WHERE EXISTS (SELECT "
           "FROM tapstudy.mirrored WHERE mirrored.store_id = store.store_id) "
           "ORDER BY site, created_utc, store_id")) {
    const ServedStore store{row[0].value(), row[1].value(), row[2].value(), row[3].value()};
    titles.emplace(store.protocol_sha256, store.title);
    if (study.empty() || store.title == study || store.protocol_sha256.starts_with(study)) {
      found.push_back(store);
    }
  }
  const bool is_one = !found.empty() && std::ranges::all_of(found, [&](const ServedStore& store) {
    return store.protocol_sha256 == found.front().protocol_sha256;
  });
  if (!is_one) {
    std::vector<std::string> named;
    for (const auto& [hash, title] : titles) {
      named.push_back(fmt::format("{} ({})", title, hash.substr(0, 8)));
    }
    throw core::InvalidInput{
        fmt::format("--study: {} has {}", server.name(),
                    named.empty() ? "no study" : fmt::format("{}", fmt::join(named, ", ")))};
  }
  return found;
}

// What its directory is called among those of its study: its site and the server's number.
std::string name_of_directory(const ServedStore& store) {
  std::string name = store.site + "-" + store.id;
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || c == '\0' || static_cast<unsigned char>(c) < 32; },
      '_');
  return name.front() == '.' ? "_" + name : name;
}

// The same rows as at the end of its last push, and the journal made from them.
void pull_store(const ServedStore& store, ServerConnection& server, const std::string& directory) {
  {
    ServerTransaction snapshot{server, "ISOLATION LEVEL REPEATABLE READ READ ONLY"};
    Database database{(fs::path{directory} / "study.db").string(), Database::Access::write};
    Transaction all{database};
    database.run(schema_sql);
    database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id,
                             schema_version));
    for (const MirroredTable& table : mirrored_tables()) {
      pull_table(store, table, server, database);
    }
    all.commit();
    snapshot.commit();
  }
  const StudyRow study = Store::open_existing(directory).study();
  Store::open_or_create(directory, study);  // which writes the journal
}
}  // namespace

std::vector<std::string> pull_study(ServerConnection& server, const std::string& study,
                                    const std::string& directory) {
  std::vector<std::string> names;
  for (const ServedStore& store : stores_of_study(server, study)) {
    names.push_back(name_of_directory(store));
    const std::string whole = (fs::path{directory} / names.back()).string();
    core::make_directories(whole);
    pull_store(store, server, whole);
  }
  return names;
}
}  // namespace tapstudy::results
