// What makes sure that a trial is stored: on the disk, in the file of the study's name, whatever
// became of that file meanwhile.
#include <fmt/format.h>

#include <filesystem>

#include "results/store.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
namespace fs = std::filesystem;

void Store::write_unconfirmed() {
  confirms_ = false;
  database_.run("PRAGMA synchronous = OFF");
  journal_->set_flush(Journal::Flush::when_asked);
}

void Store::confirm_all() {
  confirms_ = true;
  database_.run("PRAGMA synchronous = FULL");
  static_cast<void>(database_.checkpoint());
  check_has_not_moved();
  journal_->set_flush(Journal::Flush::each_time);
  journal_->flush();
}

// The log of the deleted file must not be taken for the new one's.
void Store::write_anew() {
  const std::string file = fs::absolute(database_.file()).string();
  const std::string unfinished = file + ".unfinished";
  std::error_code error;
  fs::remove(unfinished, error);  // of an earlier try, on a full disk
  Statement{database_, "VACUUM INTO ?"}.bind(unfinished).finish();
  for (const char* const beside : {"-wal", "-shm"}) {
    fs::remove(file + beside, error);
  }
  fs::rename(unfinished, file, error);
  if (error) {
    throw StoreError{fmt::format("{}: cannot be written: {}", file, error.message())};
  }
}

void Store::check_has_not_moved() {
  const fs::path file{database_.file()};
  std::error_code error;
  if (database_.has_moved()) {
    if (!fs::exists(file, error) && fs::is_directory(fs::absolute(file).parent_path(), error)) {
      write_anew();
      throw StoreRewritten{
          fmt::format("{}: was deleted during the session; its contents are in a new file of that "
                      "name (go on with "
                      "--resume)",
                      database_.file())};
    }
    throw StoreError{fmt::format(
        "{}: was moved or replaced (put it back: all answers are in the file that was moved)",
        database_.file())};
  }
}

// Read back by whoever opens the file of that name.
void Store::check_is_in_place(const TrialRow& trial) {
  check_has_not_moved();
  Database by_name{database_.file(), Database::Access::read};
  Statement row{by_name, "SELECT 1 FROM trial WHERE session_id = ? AND number = ? AND attempt = ?"};
  row.bind(trial.session_id).bind(trial.number).bind(trial.attempt);
  if (!row.step()) {
    throw StoreError{database_.file() + ": what was stored cannot be read back"};
  }
}
}  // namespace tapstudy::results
