#include "results/store/merged_copy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <string_view>

#include "results/store/schema.hpp"
#include "results/store/sqlite.hpp"
#include "results/store/store.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

// Ids that a store counts, by the names of the columns that refer to them.
struct CountedId {
  std::string_view table;
  std::string_view id;
  std::string_view order;    // of the rows of one session
  std::string_view columns;  // with blanks around each
};
constexpr std::array<CountedId, 4> counted_ids{
    {{"session", "session_id", "session_id", " session_id resumes "},
     {"trial", "trial_id", "session_id, trial_id", " trial_id "},
     {"response", "response_id",
      "(SELECT session_id FROM part.trial WHERE trial.trial_id = response.trial_id), response_id",
      " response_id supersedes "},
     {"operator_action", "action_id", "session_id, action_id", " action_id "}}};

// The tables in the order in which they are created: what refers to another comes later.
constexpr std::array<std::string_view, 14> copied_tables{
    "participant", "session",  "trial",          "alternative",    "axis_value",
    "response",    "event",    "session_event",  "form_answer",    "operator_action",
    "trace_chunk", "actuator", "actuator_chunk", "tick_statistics"};

// Which id of the whole each id of this part becomes.
void number_anew(Database& database) {
  for (const CountedId& counted : counted_ids) {
    database.run(fmt::format(
        "DROP TABLE IF EXISTS temp.new_{1}; "
        "CREATE TEMP TABLE new_{1} (old INTEGER PRIMARY KEY, new INTEGER NOT NULL); "
        "INSERT INTO temp.new_{1} SELECT {1}, (SELECT coalesce(max({1}), 0) FROM main.{0}) + "
        "row_number() OVER (ORDER BY {2}) FROM part.{0}",
        counted.table, counted.id, counted.order));
  }
}

std::string in_whole(const std::string& column) {
  for (const CountedId& counted : counted_ids) {
    if (counted.columns.find(" " + column + " ") != std::string_view::npos) {
      return fmt::format("(SELECT new FROM temp.new_{} WHERE old = {})", counted.id, column);
    }
  }
  return column;
}

void copy_table(Database& database, std::string_view table) {
  std::vector<std::string> columns;
  std::vector<std::string> values;
  Statement row{
      database,
      fmt::format("SELECT name FROM pragma_table_info('{}', 'main') ORDER BY cid", table)};
  while (row.step()) {
    columns.push_back(row.text(0));
    values.push_back(in_whole(columns.back()));
  }
  // sessions at once are stored in turns; within each, rows are in order
  const std::string first = values.front() == columns.front() ? "" : values.front() + ", ";
  database.run(fmt::format("INSERT INTO main.{0} ({1}) SELECT {2} FROM part.{0} ORDER BY {3}rowid",
                           table, fmt::join(columns, ", "), fmt::join(values, ", "), first));
}

void add_part(Database& database, const std::string& directory) {
  Statement{database, "ATTACH ? AS part"}
      .bind(fs::absolute(fs::path{directory} / "study.db").string())
      .finish();
  if (database.pragma("part.user_version") != schema_version) {
    throw StoreError{directory + ": is of another version of tapstudy than the merged study"};
  }
  {
    Transaction all{database};
    number_anew(database);
    for (const std::string_view table : copied_tables) {
      copy_table(database, table);
    }
    all.commit();
  }
  database.run("DETACH part");
}
}  // namespace

void write_merged_copy(const std::vector<std::string>& directories, const std::string& copy) {
  StudyRow study;
  {
    Store first = Store::open_existing(directories.front());
    study = first.study();
    Store::open_or_create(copy, study);
  }
  {
    Database database{(fs::path{copy} / "study.db").string(), Database::Access::write};
    database.run("PRAGMA temp_store = MEMORY");
    for (const std::string& directory : directories) {
      static_cast<void>(Store::open_existing(directory));  // which checks that it is sound
      add_part(database, directory);
    }
  }
  Store::open_or_create(copy, study);  // which writes the journal that is missing, to the disk
}
}  // namespace tapstudy::results
