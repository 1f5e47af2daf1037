#include "results/store/program_versions.hpp"

#include <filesystem>

#include "results/store/schema.hpp"
#include "results/store/sqlite.hpp"
#include "results/store/store.hpp"
namespace tapstudy::results {
// Whoever opens the store afterwards checks it; this only looks.
std::set<std::string> program_versions_in(const std::string& directory) {
  if (!Store::has_database(directory)) {
    return {};
  }
  const std::string file = (std::filesystem::path{directory} / "study.db").string();
  // what a killed program left half written, only a writer may roll back
  std::error_code error;
  const bool is_unfinished = std::filesystem::exists(file + "-journal", error);
  Database database{file, is_unfinished ? Database::Access::write : Database::Access::read};
  const std::int64_t version = database.pragma("user_version");
  if (database.pragma("application_id") != application_id || !is_known_schema(version)) {
    return {};  // another program is about to create it, or it is no study of ours
  }
  std::set<std::string> versions;
  Statement row{database, "SELECT DISTINCT program_version FROM session"};
  while (row.step()) {
    versions.insert(row.text(0));
  }
  return versions;
}
}  // namespace tapstudy::results
