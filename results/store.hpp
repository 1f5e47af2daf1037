#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/haptic_state.hpp"
#include "results/rows.hpp"
#include "results/sqlite.hpp"
namespace tapstudy::results {
// The database of one study directory, DIR/study.db: WAL journal, synchronous FULL, so that what
// was reported as saved survives a killed process and a lost mains supply. Rows are added, never
// changed. Not for use by several threads at once. Everything throws StoreError.
class Store {
 public:
  // Opens the study of this protocol in the directory, or creates both.
  // Throws InvalidInput if the directory holds the study of another protocol.
  static Store open_or_create(const std::string& directory, const StudyRow& study);
  // Throws InvalidInput if there is no study.
  static Store open_existing(const std::string& directory);

  StudyRow study();
  // Throws InvalidInput if the participant is there already in another mode.
  // The index of an existing participant, or the next free one.
  int index_of(const std::string& participant_id, Mode mode);
  bool has_sessions(const std::string& participant_id);
  // Adds the participant if new; fills in the row's id.
  void add_session(SessionRow& session);
  void add_trial(const TrialRecord& record);

  // The participant's latest session, to resume it.
  std::optional<SessionRow> latest_session(const std::string& participant_id);
  // Numbers of the trials that the participant has answered, in any session.
  std::vector<int> answered_trials(const std::string& participant_id);
  // Attempts made at a trial so far in this session.
  std::vector<AnswerRow> answers();
  std::vector<VisitRow> visits();
  std::vector<SessionRow> sessions();
  std::vector<core::TraceSample> trace(std::int64_t trial_id);

 private:
  explicit Store(Database database) : database_{std::move(database)} {}
  void check_schema();
  void create(const StudyRow& study);
  void add_details(std::int64_t trial_id, const TrialRecord& record);
  Database database_;
};
}  // namespace tapstudy::results
