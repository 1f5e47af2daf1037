#include "results/store/sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>
#include <new>
#include <utility>

#include "results/journal/journal.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
constexpr int patience_ms = 5000;  // for another process that is writing

// What SQLite's words do not say.
const char* hint_for(int code) {
  constexpr int primary = 0xff;
  switch (code) {
    case SQLITE_IOERR_WRITE:
      return " (is the disk full?)";
    case SQLITE_IOERR_LOCK:
    case SQLITE_IOERR_RDLOCK:
    case SQLITE_IOERR_UNLOCK:
    case SQLITE_IOERR_CHECKRESERVEDLOCK:
    case SQLITE_IOERR_SHMLOCK:
      return " (the file system knows no locks: a study belongs on a disk of this machine)";
    default:
      break;
  }
  switch (code & primary) {
    case SQLITE_FULL:
      return " (is the disk full?)";
    case SQLITE_BUSY:
      return " (another program is writing, or the file system knows no locks: a study belongs on "
             "a disk of this machine)";
    case SQLITE_CANTOPEN:
      return " (may it and its directory be written? where not, a copy can be read)";
    default:
      return "";
  }
}

StoreError failure(const std::string& file, sqlite3* handle, int code) {
  const char* words = handle != nullptr ? sqlite3_errmsg(handle) : sqlite3_errstr(code);
  constexpr int primary = 0xff;
  const bool is_damaged = (code & primary) == SQLITE_CORRUPT || (code & primary) == SQLITE_NOTADB;
  return StoreError{fmt::format("{}: {}{}{}", file, words, hint_for(code),
                                is_damaged ? where_answers_are(file) : "")};
}

// Absolute, because SQLite may be built to take "file:…" for a URI.
std::string path_of(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path path = fs::absolute(file, error);
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw StoreError{file + ": is not a regular file"};
  }
  return path.string();
}
}  // namespace

void Database::Close::operator()(sqlite3* handle) const {
  sqlite3_close_v2(handle);
}

Database::Database(const std::string& file, Access access)
    : Database{{file, path_of(file),
                access == Access::read ? SQLITE_OPEN_READONLY
                                       : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE},
               access} {}

Database Database::in_memory(const std::string& name) {
  return {{name, ":memory:", SQLITE_OPEN_READWRITE}, Access::write};
}

Database::Database(const Opening& opening, Access access) : file_{opening.name}, access_{access} {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(opening.path.c_str(), &handle, opening.flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) {
    throw failure(file_, handle, code);
  }
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, patience_ms);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the way of the C library
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

bool Database::is_in_transaction() const {
  return sqlite3_get_autocommit(handle_.get()) == 0;
}

bool Database::has_moved() const {
  int has_moved = 0;
  sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_HAS_MOVED, &has_moved);
  return has_moved != 0;
}

bool Database::checkpoint() {
  sqlite3_busy_timeout(handle_.get(), 0);  // a session does not wait for a reader
  const int code = sqlite3_wal_checkpoint_v2(handle_.get(), "main", SQLITE_CHECKPOINT_TRUNCATE,
                                             nullptr, nullptr);
  sqlite3_busy_timeout(handle_.get(), patience_ms);
  if (code != SQLITE_OK && code != SQLITE_BUSY) {
    throw failure(file_, handle_.get(), code);
  }
  return code == SQLITE_OK;
}

void Database::limit_time(std::chrono::seconds limit) {
  constexpr int instructions_between_looks = 10'000;
  time_limit_ = std::make_unique<std::chrono::steady_clock::time_point>(
      std::chrono::steady_clock::now() + limit);
  sqlite3_progress_handler(
      handle_.get(), instructions_between_looks,
      [](void* end) {
        return std::chrono::steady_clock::now() >
                       *static_cast<std::chrono::steady_clock::time_point*>(end)
                   ? 1
                   : 0;
      },
      time_limit_.get());
}

void Database::lift_limit() {
  sqlite3_progress_handler(handle_.get(), 0, nullptr, nullptr);
  time_limit_.reset();
}

void Database::run(const std::string& sql) {
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) {
    throw failure(file_, handle_.get(), code);
  }
}

std::int64_t Database::pragma(const std::string& name) {
  Statement statement{*this, "PRAGMA " + name};
  statement.step();
  return statement.integer(0);
}

std::int64_t Database::last_row_id() const {
  return sqlite3_last_insert_rowid(handle_.get());
}

void Database::Finalise::operator()(sqlite3_stmt* handle) const {
  sqlite3_finalize(handle);
}

Database::Prepared Database::prepared(const std::string& sql) {
  if (const auto kept = kept_.find(sql); kept != kept_.end()) {
    return std::move(kept_.extract(kept).mapped());
  }
  sqlite3_stmt* handle = nullptr;
  const int code = sqlite3_prepare_v3(handle_.get(), sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT,
                                      &handle, nullptr);
  if (code != SQLITE_OK) {
    throw failure(file_, handle_.get(), code);
  }
  return Prepared{handle};
}

// A statement left open would hold its rows' lock; texts and traces bound to it would stay in
// memory.
void Database::keep(Prepared statement) noexcept {
  constexpr std::size_t most_kept = 64;
  if (statement == nullptr || kept_.size() >= most_kept) {
    return;
  }
  sqlite3_reset(statement.get());  // repeats the error of the last step, which has been thrown
  sqlite3_clear_bindings(statement.get());
  try {
    std::string sql = sqlite3_sql(statement.get());
    kept_.emplace(std::move(sql), std::move(statement));
  } catch (const std::bad_alloc&) {  // NOLINT(bugprone-empty-catch): prepared anew next time
  }
}

Statement::Statement(Database& database, const std::string& sql)
    : database_{&database}, handle_{database.prepared(sql)} {}

Statement::~Statement() {
  database_->keep(std::move(handle_));
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) {
    throw failure(database_->file(), database_->handle_.get(), code);
  }
}

Statement& Statement::bind(const std::string& text) {
  check(sqlite3_bind_text64(handle_.get(), ++bound_, text.data(), text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}
Statement& Statement::bind(std::int64_t number) {
  check(sqlite3_bind_int64(handle_.get(), ++bound_, number));
  return *this;
}
Statement& Statement::bind(double number) {
  check(sqlite3_bind_double(handle_.get(), ++bound_, number));
  return *this;
}
Statement& Statement::bind(std::span<const std::byte> bytes) {
  check(sqlite3_bind_blob64(handle_.get(), ++bound_, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}
Statement& Statement::bind_null() {
  check(sqlite3_bind_null(handle_.get(), ++bound_));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    throw failure(database_->file(), database_->handle_.get(), code);
  }
  return code == SQLITE_ROW;
}

std::string Statement::text(int column) {
  const auto* const text = sqlite3_column_text(handle_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column));
  const void* const raw = text;
  return text == nullptr ? std::string{} : std::string{static_cast<const char*>(raw), size};
}
bool Statement::is_null(int column) {
  return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) {
  return sqlite3_column_int64(handle_.get(), column);
}
double Statement::real(int column) {
  return sqlite3_column_double(handle_.get(), column);
}
std::vector<std::byte> Statement::bytes(int column) {
  const auto* const first =
      static_cast<const std::byte*>(sqlite3_column_blob(handle_.get(), column));
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column));
  return first == nullptr ? std::vector<std::byte>{} : std::vector<std::byte>{first, first + size};
}

Transaction::Transaction(Database& database)
    : database_{&database}, is_part_{database.is_in_transaction()} {
  database.run(is_part_ ? "SAVEPOINT part" : "BEGIN IMMEDIATE");
}
Transaction::~Transaction() {
  if (!is_open_) {
    return;
  }
  try {
    database_->run(is_part_ ? "ROLLBACK TO part; RELEASE part" : "ROLLBACK");
  } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): SQLite has rolled back by itself
  }
}
void Transaction::commit() {
  database_->run(is_part_ ? "RELEASE part" : "COMMIT");
  is_open_ = false;
}
}  // namespace tapstudy::results
