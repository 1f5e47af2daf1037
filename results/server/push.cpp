#include "results/server/push.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "results/server/mirrored_tables.hpp"
#include "results/server/server_schema.hpp"
#include "results/store/schema.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
// Where a table is: the last row, and the hash of all up to it.
struct Mark {
  std::int64_t last_row{};
  std::string hash;
};

struct StoreOfSite {
  std::string id;  // the server's number
  std::string site;
  std::string directory;
  std::string title;
  std::string protocol_sha256;
};

StoreOfSite store_of_site(const std::string& directory, const std::string& site, Store& store,
                          ServerConnection& server) {
  Statement study = store.query("SELECT title, protocol_sha256, created_utc FROM study");
  if (!study.step()) {
    throw StoreError{directory + ": holds no study"};
  }
  const std::vector<std::string> key{site, study.text(1), study.text(2)};
  server.rows(
      "INSERT INTO tapstudy.store (site, protocol_sha256, created_utc, title) "
      "VALUES ($1, $2, $3, $4) ON CONFLICT DO NOTHING",
      {key[0], key[1], key[2], study.text(0)});
  const auto found = server.rows(
      "SELECT store_id FROM tapstudy.store WHERE site = $1 AND protocol_sha256 = $2 AND "
      "created_utc = $3",
      key);
  return {found.at(0).at(0).value(), site, directory, study.text(0), study.text(1)};
}

// What others have shown of the same study.
constexpr const char* others_sessions_sql = R"sql(
SELECT site, participant_id, seed, started_utc
  FROM tapstudy.session JOIN tapstudy.store USING (store_id) JOIN tapstudy.mirrored USING (store_id)
  WHERE store_id <> $1 AND protocol_sha256 = $2 AND table_name = 'session' AND row_id <= last_row_id
  ORDER BY store_id, row_id
)sql";

// A report takes no session twice, and no two participants of one name. Nobody can delete a row, so
// that a store which does not fit the others is refused before others see it.
void check_fits_others(const StoreOfSite& of_site, Store& store, ServerConnection& server) {
  std::set<std::string> participants;
  std::set<std::pair<std::string, std::string>> sessions;
  Statement own = store.query("SELECT participant_id, seed, started_utc FROM session");
  while (own.step()) {
    participants.insert(own.text(0));
    sessions.emplace(fmt::format("{}", own.integer(1)), own.text(2));
  }
  for (const auto& row : server.rows(others_sessions_sql, {of_site.id, of_site.protocol_sha256})) {
    const std::string& site = row[0].value();
    const std::string& participant = row[1].value();
    if (sessions.contains({row[2].value(), row[3].value()})) {
      throw StoreError{fmt::format(
          "{}: {} has pushed the session of {} that {} holds: is one a copy of the other, or "
          "was this pushed under the name --site {} before?",
          server.name(), site, row[3].value(), of_site.directory, site)};
    }
    if (participants.contains(participant)) {
      throw StoreError{fmt::format(
          "{}: {} has pushed a participant {}, as {} holds one: ids differ among the sites of a "
          "study (redact --prefix {} makes such a copy)",
          server.name(), site, participant, of_site.directory, of_site.site)};
    }
  }
}

std::optional<StudyOfOtherText> other_text(const StoreOfSite& store, ServerConnection& server) {
  const auto found = server.rows(
      "SELECT title, protocol_sha256, site FROM tapstudy.store WHERE title = $1 AND "
      "protocol_sha256 <> $2 ORDER BY store_id LIMIT 1",
      {store.title, store.protocol_sha256});
  if (found.empty()) {
    return std::nullopt;
  }
  return StudyOfOtherText{found[0][0].value(), found[0][1].value(), found[0][2].value()};
}

// Held until the connection ends, however it ends.
void lock(const StoreOfSite& store, ServerConnection& server) {
  const auto locked = server.rows(
      "SELECT pg_try_advisory_lock(hashtext('tapstudy.push'), $1::bigint::int)", {store.id});
  if (locked.at(0).at(0) != "t") {
    throw StoreError{fmt::format("{}: another push of this study of {} is under way", server.name(),
                                 store.site)};
  }
}

Mark mark_of(const StoreOfSite& store, const MirroredTable& table, ServerConnection& server) {
  const auto found = server.rows(
      "SELECT last_row_id, sha256 FROM tapstudy.mirrored WHERE store_id = $1 AND table_name = $2",
      {store.id, table.name});
  return found.empty() ? Mark{} : Mark{std::stoll(found[0][0].value()), found[0][1].value()};
}

// Of a push that was cut off, too.
std::int64_t last_row_of(const StoreOfSite& store, const MirroredTable& table,
                         ServerConnection& server) {
  const auto found = server.rows(
      fmt::format("SELECT coalesce(max(row_id), 0) FROM tapstudy.{} WHERE store_id = $1",
                  table.name),
      {store.id});
  return std::stoll(found.at(0).at(0).value());
}

class TablePush {
 public:
  TablePush(const StoreOfSite& store, const MirroredTable& table, ServerConnection& server)
      : store_{&store},
        table_{&table},
        server_{&server},
        shown_{mark_of(store, table, server)},
        there_{last_row_of(store, table, server)} {}

  void add(Statement& row) {
    const std::string line = copy_line(*table_, row);
    here_ = {row.integer(0), hash_after(here_.hash, line)};
    if (here_.last_row == shown_.last_row && here_.hash != shown_.hash) {
      fail("differ from those that it was sent before");
    }
    was_shown_ = was_shown_ || here_.last_row == shown_.last_row;
    if (here_.last_row > there_) {
      ++added_;
      lines_ += store_->id + '\t' + line;
    }
    constexpr std::size_t at_once = 4 << 20;
    if (lines_.size() >= at_once) {
      send();
    }
  }
  Mark finish() {
    send();
    if (!was_shown_ && shown_.last_row > 0) {
      fail("are fewer than those that it was sent before");
    }
    return here_;
  }
  std::int64_t added() const { return added_; }

 private:
  void send() {
    if (!lines_.empty()) {
      server_->copy_in(fmt::format("COPY tapstudy.{} (store_id, row_id, {}) FROM STDIN",
                                   table_->name, table_->column_list()),
                       lines_);
      lines_.clear();
    }
  }
  [[noreturn]] void fail(const std::string& how) const {
    throw StoreError{fmt::format(
        "{}: rows of {} in {} {}: is this the study of another machine of {}, or was a backup put "
        "back? (--site names each machine)",
        server_->name(), table_->name, store_->directory, how, store_->site)};
  }

  const StoreOfSite* store_;
  const MirroredTable* table_;
  ServerConnection* server_;
  Mark shown_;  // what others see
  std::int64_t there_;
  Mark here_;
  std::int64_t added_{};
  std::string lines_;
  bool was_shown_{false};
};

// One push after the other, so that of two which do not fit one another the second is refused.
void show(const StoreOfSite& of_site, const std::vector<Mark>& marks, Store& store,
          ServerConnection& server) {
  ServerTransaction all{server};
  server.rows("SELECT pg_advisory_xact_lock(hashtext('tapstudy.show'), hashtext($1))",
              {of_site.protocol_sha256});
  check_fits_others(of_site, store, server);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    server.rows(
        "INSERT INTO tapstudy.mirrored VALUES ($1, $2, $3, $4) ON CONFLICT (store_id, table_name) "
        "DO UPDATE SET last_row_id = excluded.last_row_id, sha256 = excluded.sha256",
        {of_site.id, mirrored_tables()[i].name, std::to_string(marks[i].last_row), marks[i].hash});
  }
  all.commit();
}

std::size_t rows_of(Store& store) {
  std::size_t rows = 0;
  for (const MirroredTable& table : mirrored_tables()) {
    Statement count = store.query(fmt::format("SELECT count(*) FROM {}", table.name));
    rows += count.step() ? static_cast<std::size_t>(count.integer(0)) : 0;
  }
  return rows;
}

void check_is_of_this_version(const std::string& directory, Store& store) {
  Statement version = store.query("SELECT user_version FROM pragma_user_version");
  if (!version.step() || version.integer(0) != schema_version) {
    throw StoreError{
        fmt::format("{}: is of an earlier version of tapstudy, whose stores a server does not take",
                    directory)};
  }
}
}  // namespace

Pushed push_store(const std::string& directory, const std::string& site, ServerConnection& server,
                  const core::CountHook& count) {
  if (site.empty()) {
    throw core::InvalidInput{"a site has a name"};
  }
  check_server_schema(server);
  Store store = Store::open_existing(directory);
  check_is_of_this_version(directory, store);
  Pushed pushed;
  store.in_read_transaction([&] {
    const StoreOfSite of_site = store_of_site(directory, site, store, server);
    lock(of_site, server);
    check_fits_others(of_site, store, server);
    pushed.other_text = other_text(of_site, server);
    const std::size_t all = rows_of(store);
    std::vector<Mark> marks;
    for (const MirroredTable& table : mirrored_tables()) {
      TablePush push{of_site, table, server};
      Statement row = store.query(table.select());
      while (row.step()) {
        push.add(row);
        core::tell_count(count, static_cast<std::size_t>(++pushed.all_rows), all);
      }
      marks.push_back(push.finish());
      pushed.rows += push.added();
    }
    show(of_site, marks, store, server);
  });
  return pushed;
}
}  // namespace tapstudy::results
