#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/haptic_state.hpp"
#include "results/rows.hpp"
#include "results/sqlite.hpp"
namespace tapstudy::results {
// The database of one study directory, DIR/study.db: WAL journal, synchronous FULL, so that
// committed data survive a killed process and a power failure. Rows are added, never changed. Not
// thread-safe. All functions throw StoreError.
class Store {
 public:
  // Opens the study of this protocol in the directory, or creates both.
  // Throws InvalidInput if the directory holds the study of another protocol, or of other surfaces.
  static Store open_or_create(const std::string& directory, const StudyRow& study);
  // For reading. Throws InvalidInput if there is no study.
  static Store open_existing(const std::string& directory);
  // Leaves a writer's database as a single file, without the WAL files.
  ~Store();
  Store(Store&& other) noexcept = default;
  Store& operator=(Store&& other) noexcept = delete;
  Store(const Store& other) = delete;
  Store& operator=(const Store& other) = delete;

  // Includes its surfaces, decompressed.
  StudyRow study();
  // The index of an existing participant, or the next free one of the mode.
  // Throws InvalidInput if the participant is there already in another mode.
  int index_of(const std::string& participant_id, Mode mode);
  bool has_sessions(const std::string& participant_id);
  // Adds the participant if new; fills in the row's id.
  void add_session(SessionRow& session);
  // Throws StoreError also if the participant has answered this trial already, in any session.
  void add_trial(const TrialRecord& record);

  // The participant's latest session, to resume it.
  std::optional<SessionRow> latest_session(const std::string& participant_id);
  // Numbers of the trials that the participant has answered, in any session.
  std::vector<int> answered_trials(const std::string& participant_id);
  // Of all participants and modes, including practice: the caller filters. Sorted by participant
  // index and trial number; participants of different modes can have the same index.
  std::vector<AnswerRow> answers();
  std::vector<VisitRow> visits();
  std::vector<SessionRow> sessions();
  // Every tick of a trial, in order; empty if there is no such trial.
  std::vector<core::TraceSample> trace(std::int64_t trial_id);

 private:
  explicit Store(Database database) : database_{std::move(database)} {}
  void check_schema();
  std::vector<SurfaceRow> surfaces();
  void add_surfaces(const StudyRow& study);
  void check_surfaces(const StudyRow& stored, const StudyRow& present) const;
  bool is_empty();
  void create_or_check(const StudyRow& study);
  void check_not_answered(const TrialRow& trial);
  void add_details(std::int64_t trial_id, const TrialRecord& record);
  Database database_;
};
}  // namespace tapstudy::results
