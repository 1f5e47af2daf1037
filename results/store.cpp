#include "results/store.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <span>
#include <thread>

#include "results/compression.hpp"
#include "results/schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

std::string database_file(const std::string& directory) {
  return (fs::path{directory} / "study.db").string();
}

void make_directory(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw StoreError{fmt::format("{}: cannot be created: {}", directory, error.message())};
  }
}

std::int64_t pragma(Database& database, const std::string& name) {
  Statement statement{database, "PRAGMA " + name};
  statement.step();
  return statement.integer(0);
}

// Changing the journal mode briefly needs exclusive access, and SQLite does not wait for it.
void use_write_ahead_log(Database& database) {
  constexpr int attempts = 50;
  for (int attempt = 1;; ++attempt) {
    try {
      database.run(
          "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; "
          "PRAGMA foreign_keys = ON");
      return;
    } catch (const StoreError&) {
      if (attempt == attempts) {
        throw;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
  }
}

}  // namespace

Store Store::open_or_create(const std::string& directory, const StudyRow& study) {
  make_directory(directory);
  Store store{Database{database_file(directory), Database::Access::write}};
  if (!store.is_empty()) {
    store.check_schema();  // before anything in it is changed
  }
  use_write_ahead_log(store.database_);
  store.create_or_check(study);
  return store;
}

Store Store::open_existing(const std::string& directory) {
  std::error_code error;
  if (!fs::exists(database_file(directory), error)) {
    throw core::InvalidInput{fmt::format("{}: there is no study here (no study.db)", directory)};
  }
  Store store{Database{database_file(directory), Database::Access::read}};
  store.check_schema();
  return store;
}

Store::~Store() {
  if (!database_.is_open() || !database_.can_write()) {
    return;
  }
  try {
    database_.run("PRAGMA journal_mode = DELETE");
  } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): another process has it open
  }
}

bool Store::is_empty() {
  Statement tables{database_, "SELECT count(*) FROM sqlite_master"};
  tables.step();
  return tables.integer(0) == 0;
}

void Store::check_schema() {
  if (pragma(database_, "application_id") != application_id) {
    throw StoreError{database_.file() + ": is not a tapstudy database"};
  }
  const std::int64_t version = pragma(database_, "user_version");
  if (version != schema_version) {
    throw StoreError{fmt::format("{}: has schema {}, this program reads {}", database_.file(),
                                 version, schema_version)};
  }
}

// In one transaction: of two programs started concurrently one creates, the other finds it.
void Store::create_or_check(const StudyRow& study) {
  Transaction all{database_};
  if (!is_empty()) {
    check_schema();
    const StudyRow present = this->study();
    if (present.protocol_sha256 != study.protocol_sha256) {
      throw core::InvalidInput{
          fmt::format("{}: holds the study of another protocol, '{}' (choose another --out; to "
                      "change a running "
                      "study, start a new one)",
                      database_.file(), present.title)};
    }
    check_surfaces(present, study);
    return;
  }
  database_.run(schema_sql);
  database_.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id,
                            schema_version));
  Statement{database_,
            "INSERT INTO study (id, title, protocol_file, protocol_text, protocol_sha256, "
            "created_utc) VALUES (1, ?, ?, ?, ?, ?)"}
      .bind(study.title)
      .bind(study.protocol_file)
      .bind(study.protocol_text)
      .bind(study.protocol_sha256)
      .bind(fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))))
      .finish();
  add_surfaces(study);
  all.commit();
}

void Store::add_surfaces(const StudyRow& study) {
  for (const SurfaceRow& surface : study.surfaces) {
    const auto packed = compressed(std::as_bytes(std::span{surface.bytes}));
    Statement{database_, "INSERT INTO surface (file, sha256, size, zstd) VALUES (?, ?, ?, ?)"}
        .bind(surface.file)
        .bind(surface.sha256)
        .bind(static_cast<std::int64_t>(surface.bytes.size()))
        .bind(std::span<const std::byte>{packed})
        .finish();
  }
}

// A session must not go on with another body.
void Store::check_surfaces(const StudyRow& stored, const StudyRow& present) const {
  for (const SurfaceRow& surface : present.surfaces) {
    const auto before = std::ranges::find(stored.surfaces, surface.file, &SurfaceRow::file);
    if (before == stored.surfaces.end() || before->sha256 != surface.sha256) {
      throw core::InvalidInput{fmt::format(
          "{}: '{}' is not the surface that the study began with (put that one back, or "
          "start a new study)",
          database_.file(), surface.file)};
    }
  }
}

StudyRow Store::study() {
  Statement row{database_,
                "SELECT title, protocol_file, protocol_text, protocol_sha256 FROM study"};
  if (!row.step()) {
    throw StoreError{database_.file() + ": the study's own row is missing"};
  }
  return {row.text(0), row.text(1), row.text(2), row.text(3), surfaces()};
}
}  // namespace tapstudy::results
