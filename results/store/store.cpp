#include "results/store/store.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <thread>

#include "core/text/plain_text.hpp"
#include "results/compression.hpp"
#include "results/store/schema.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

std::string database_file(const std::string& directory) {
  return (fs::path{directory} / "study.db").string();
}
bool exists(const std::string& file) {
  std::error_code error;
  return fs::exists(file, error);
}

void make_directory(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) {
    throw StoreError{fmt::format("{}: cannot be created: {}", directory, error.message())};
  }
}

// Left by a program that died while it closed the file, or whose disk failed then. Whoever only
// reads may not roll back.
void roll_back_unfinished(const std::string& directory) {
  const std::string file = database_file(directory);
  if (exists(file + "-journal")) {
    Database writable{file, Database::Access::write};
    writable.pragma("schema_version");
  }
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

StoreError missing_database(const std::string& directory) {
  const std::string file = database_file(directory);
  return StoreError{file + ": is missing" + where_answers_are(file)};
}
StoreError emptied_database(const std::string& directory) {
  const std::string file = database_file(directory);
  return StoreError{file + ": holds nothing any more" + where_answers_are(file)};
}
}  // namespace

Store Store::open_or_create(const std::string& directory, const StudyRow& study,
                            const AcceptText& accept) {
  make_directory(directory);
  // looked at before the database is: whoever begins both begins with that one
  const JournalSummary journal = summary_of_journal(directory);
  if (!has_database(directory) && journal.has_lines) {
    throw missing_database(directory);
  }
  if (journal.has_lines && !is_begun(directory)) {
    throw emptied_database(directory);
  }
  Store store{Database{database_file(directory), Database::Access::write}, Journal{directory}};
  if (!store.is_empty()) {
    store.check_is_sound();  // before anything in it is changed
  }
  use_write_ahead_log(store.database_);
  store.create_or_check(study, accept);
  store.check_is_of_journal(journal);
  // a program killed between the two leaves the journal an answer behind
  store.journal_->complete([&] { return store.study(); }, store.sessions(),
                           store.entries_for_journal());
  return store;
}

Store Store::open_existing(const std::string& directory) {
  if (!has_database(directory) && has_journal(directory)) {
    throw missing_database(directory);
  }
  if (!has_database(directory)) {
    throw core::InvalidInput{fmt::format("{}: there is no study here (no study.db)", directory)};
  }
  roll_back_unfinished(directory);
  Store store{Database{database_file(directory), Database::Access::read}, std::nullopt};
  if (store.is_empty() && has_journal(directory)) {
    throw emptied_database(directory);
  }
  if (store.is_empty()) {
    throw StoreError{fmt::format(
        "{}: is the unfinished beginning of a study, and holds nothing (its program was ended "
        "before the first session; another with the same --out begins it anew)",
        database_file(directory))};
  }
  store.check_is_sound();
  return store;
}

std::string Store::directory() const {
  return fs::path{database_.file()}.parent_path().string();
}

bool Store::has_database(const std::string& directory) {
  return exists(database_file(directory));
}
bool Store::has_journal(const std::string& directory) {
  return summary_of_journal(directory).has_lines;
}
bool Store::is_begun(const std::string& directory) {
  if (!has_database(directory)) {
    return false;
  }
  roll_back_unfinished(directory);
  return !Store{Database{database_file(directory), Database::Access::read}, std::nullopt}
              .is_empty();
}

Store Store::from_journal(const std::string& directory) {
  const JournalContent content = read_journal(directory);
  Store store{Database::in_memory(journal_file(directory)), std::nullopt};
  store.create(content.study);
  std::map<std::int64_t, std::int64_t>
      new_ids;  // before 0.3 journals lack sessions without an answer
  for (SessionRow session : content.sessions) {
    const std::int64_t id = session.id;
    session.resumes.reset();
    store.add_session(session);
    new_ids[id] = session.id;
  }
  const auto new_id = [&](std::int64_t id) {
    const auto found = new_ids.find(id);
    if (found == new_ids.end()) {
      throw StoreError{fmt::format("{}: has entries of session {}, but not the session",
                                   store.database_.file(), id)};
    }
    return found->second;
  };
  for (const JournalledAnswer& answer : content.entries.answers) {
    TrialRecord record;
    record.trial = answer.trial;
    record.alternatives = answer.alternatives;
    record.response = answer.response;
    record.trial.session_id = new_id(answer.trial.session_id);
    store.add_trial(record);
  }
  for (CorrectionRow correction : content.entries.corrections) {
    correction.session_id = new_id(correction.session_id);
    store.insert_correction(correction);
  }
  for (OperatorActionRow action : content.entries.actions) {
    action.session_id = new_id(action.session_id);
    store.insert_action(action);
  }
  for (FormAnswerRow answer : content.entries.form_answers) {
    answer.session_id = new_id(answer.session_id);
    store.insert_form_answer(answer);
  }
  return store;
}

Store::~Store() {
  if (!database_.is_open() || !database_.can_write()) {
    return;
  }
  try {
    journal_failed_calls();
  } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): whoever opens it next does
  }
  try {
    // a file that was deleted or moved leaves the log beside that name to the one that is there now
    if (!database_.has_moved()) {
      // extra: of this change, too, a power failure leaves nothing to roll back
      database_.run("PRAGMA synchronous = EXTRA; PRAGMA journal_mode = DELETE");
    }
  } catch (const StoreError&) {  // NOLINT(bugprone-empty-catch): another process has it open
  }
}

namespace {
// The line, from 1, from which two texts differ.
std::ptrdiff_t first_difference(const std::string& one, const std::string& other) {
  const auto [end, ignored] = std::ranges::mismatch(one, other);
  return 1 + std::count(one.begin(), end, '\n');
}
}  // namespace

// Runs in one transaction: of two programs started concurrently one creates the study, the other
// finds it.
void Store::create_or_check(const StudyRow& study, const AcceptText& accept) {
  Transaction all{database_};
  if (!is_empty()) {
    check_version();
    const StudyRow stored = accept ? this->study() : study_without_surfaces();
    if (stored.protocol_sha256 != study.protocol_sha256) {
      if (!accept || !has_columns_of_planned_sessions()) {
        throw core::InvalidInput{fmt::format(
            "{}: holds the study of another protocol, '{}', whose text differs from line {} on "
            "(choose another --out; to change a running study, start a new one)",
            database_.file(), stored.title,
            first_difference(stored.protocol_text, study.protocol_text))};
      }
      accept(stored, latest_protocol_text().value_or(stored.protocol_text));
      changed_protocol_text_ = study.protocol_text;
    } else if (accept && has_columns_of_planned_sessions()) {
      if (const auto latest = latest_protocol_text(); latest && *latest != stored.protocol_text) {
        accept(stored, *latest);  // back to the text of the beginning
      }
    }
    check_surfaces(study);
    return;
  }
  create(study);
  all.commit();
}

// Sessions are stored before they are journalled: a database that lacks one is another's, or an
// earlier copy, and what it added would stand among answers that it does not know.
void Store::check_is_of_journal(const JournalSummary& journal) {
  if (!journal.has_lines) {
    return;
  }
  const auto refuse = [&](const std::string& what) {
    throw StoreError{
        fmt::format("{}: is of another study than {} beside it: it holds {} (put its own "
                    "study.db back, or choose another --out)",
                    journal_file(directory()), database_.file(), what)};
  };
  if (!journal.protocol_sha256.empty() &&
      journal.protocol_sha256 != study_without_surfaces().protocol_sha256) {
    refuse("what was answered under another protocol");
  }
  const std::vector<SessionRow> stored = sessions();
  for (const SessionRow& session : journal.sessions) {
    const auto same = std::ranges::find(stored, session.id, &SessionRow::id);
    if (same == stored.end() || same->seed != session.seed ||
        same->started_utc != session.started_utc) {
      refuse(fmt::format("session {} of participant '{}', which this one lacks", session.id,
                         session.participant_id));
    }
  }
}

// Of the latest session; unset: there is none yet.
std::optional<std::string> Store::latest_protocol_text() {
  Statement row{database_,
                "SELECT coalesce(session.protocol_text, study.protocol_text) FROM session "
                "JOIN study ORDER BY session_id DESC LIMIT 1"};
  return row.step() ? std::optional{row.text(0)} : std::nullopt;
}

void Store::create(const StudyRow& study) {
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

// A session must not go on with another body, or other pictures.
void Store::check_surfaces(const StudyRow& study) {
  for (const SurfaceRow& surface : study.surfaces) {
    Statement stored{database_, "SELECT sha256 FROM surface WHERE file = ?"};
    stored.bind(surface.file);
    if (!stored.step() || stored.text(0) != surface.sha256) {
      throw core::InvalidInput{
          fmt::format("{}: '{}' is not the file that the study began with (put that one back, or "
                      "start a new study)",
                      database_.file(), surface.file)};
    }
  }
}

StudyRow Store::study_without_surfaces() {
  Statement row{database_,
                "SELECT title, protocol_file, protocol_text, protocol_sha256 FROM study"};
  if (!row.step()) {
    throw StoreError{database_.file() + ": the study's own row is missing" +
                     where_answers_are(database_.file())};
  }
  return {row.text(0), row.text(1), row.text(2), row.text(3), {}};
}

StudyRow Store::study() {
  StudyRow study = study_without_surfaces();
  study.surfaces = surfaces();
  return study;
}

void Store::each_row(const std::string& select, const std::function<void(Statement&)>& show) {
  Statement row{database_, select};
  while (row.step()) {
    show(row);
  }
}

void Store::in_read_transaction(const std::function<void()>& read) {
  database_.run("BEGIN");
  try {
    read();
  } catch (...) {
    database_.run("ROLLBACK");
    throw;
  }
  database_.run("COMMIT");
}

// Whether the database holds no table at all.
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
    throw StoreError{fmt::format("{}: is damaged: {}{}", database_.file(), check.text(0),
                                 where_answers_are(database_.file()))};
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
  reference.run(schema_sql_of(static_cast<int>(database_.pragma("user_version"))));
  const std::set<std::string> known = objects_of(reference);
  const std::set<std::string> found = objects_of(database_);
  for (const std::string& object : found) {
    if (!known.contains(object)) {
      throw StoreError{fmt::format("{}: contains a schema object that is not tapstudy's: {}{}",
                                   database_.file(), core::cut_to(object, 80),
                                   where_answers_are(database_.file()))};
    }
  }
  if (found.size() != known.size()) {
    throw StoreError{database_.file() + ": lacks some of tapstudy's tables" +
                     where_answers_are(database_.file())};
  }
}

void Store::check_version() {
  if (database_.pragma("application_id") != application_id) {
    throw StoreError{database_.file() + ": is not a tapstudy database" +
                     where_answers_are(database_.file())};
  }
  const std::int64_t version = database_.pragma("user_version");
  if (!is_known_schema(version)) {
    throw StoreError{
        fmt::format("{}: has schema {}, this program reads {} to {} (the version of tapstudy that "
                    "wrote it reads it)",
                    database_.file(), version, first_schema_version, schema_version)};
  }
}

bool Store::has_columns_of_groups() {
  return database_.pragma("user_version") >= first_version_with_groups;
}

bool Store::has_tables_of_actuators() {
  return database_.pragma("user_version") >= first_version_with_actuators;
}
bool Store::has_columns_of_planned_sessions() {
  return database_.pragma("user_version") >= first_version_with_planned_sessions;
}
}  // namespace tapstudy::results
