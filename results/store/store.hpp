#pragma once
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/haptics/haptic_state.hpp"
#include "results/journal/journal.hpp"
#include "results/rows.hpp"
#include "results/store/sqlite.hpp"
#include "results/traces/trace_codec.hpp"
namespace tapstudy::results {
// Whether study.db alone holds all that was stored. Where another connection keeps it open, the
// latest is in study.db-wal beside it.
enum class SaveOutcome { in_one_file, partly_in_log };

// The database of one study directory, DIR/study.db: write-ahead log, synchronous FULL, so that
// committed data survive a killed process and a power failure. Rows are added, never changed.
// Answers are recorded a second time in DIR/answers.journal (journal.hpp). Not thread-safe. All
// functions throw StoreError.
class Store {
 public:
  // Of a protocol whose text is another than the study's, or than that of the latest session:
  // throws InvalidInput unless it asks for the same data.
  using AcceptText =
      std::function<void(const StudyRow& stored, const std::string& text_of_latest_session)>;
  // Opens the study of this protocol in the directory, or creates both; checks the database's
  // integrity and that it holds tapstudy's tables and nothing else.
  // Throws InvalidInput if the directory holds the study of another protocol, or of other surfaces.
  // Where another protocol is accepted, sessions that are added are stored with its text.
  static Store open_or_create(const std::string& directory, const StudyRow& study,
                              const AcceptText& accept = {});
  // Opens a study for reading, with the same checks. Throws InvalidInput if there is no study.
  static Store open_existing(const std::string& directory);
  // A store in memory rebuilt from the journal alone: answers without traces, events, statistics of
  // ticks and trials that timed out. Throws StoreError if the journal does not hold together.
  static Store from_journal(const std::string& directory);
  static bool has_database(const std::string& directory);
  static bool has_journal(const std::string& directory);  // with something in it
  // False also of a database whose program was ended before it had created the study.
  static bool is_begun(const std::string& directory);
  // Until resume_sync(), trials without traces are committed and journalled some dozens at a time,
  // nothing waits for the disk and nothing is read back. A killed program loses trials that were
  // added, and a power cut may damage the file: only for new studies of simulated participants,
  // which their seed reproduces.
  void suspend_sync();
  void resume_sync();
  // Leaves a writer's database as a single file, without the WAL files.
  ~Store();
  Store(Store&& other) noexcept = default;
  Store& operator=(Store&& other) noexcept = delete;
  Store(const Store& other) = delete;
  Store& operator=(const Store& other) = delete;

  std::string directory() const;
  // Includes its surfaces, decompressed.
  StudyRow study();
  struct Place {
    int participant_index;
    int order_index;
  };
  // Facts about other participants that the store does not hold.
  struct OtherParticipants {
    std::function<bool(const std::string& participant_id)> is_in_session;
    std::function<bool(const std::string& participant_id)> has_trials_left;
  };
  // Order indices of a mode, each with a participant who uses it up, but for this one. Those who
  // were excluded, whose session the operator ended with trials left, or who are no longer in a
  // session and answered nothing that counts, use none up.
  std::map<int, std::string> orders_used_beside(const std::string& participant_id, Mode mode,
                                                const OtherParticipants& others);
  // The place of an existing participant, or the next free one of the mode. The order is the first
  // that no other participant of the mode uses up. Where `may_have` is given, the first of those
  // orders that may be had. Throws InvalidInput if the participant is there already in another
  // mode.
  Place place_of(const std::string& participant_id, Mode mode, const OtherParticipants& others,
                 const std::function<bool(int order_index)>& may_have = {});
  // Whether any participant is in a group.
  bool has_groups();
  // Whether any session is one of the protocol's; has another text of the protocol.
  bool has_planned_sessions();
  bool has_changed_texts();
  // No other program adds anything while `act` runs; all that it adds is kept, or nothing.
  void in_one_transaction(const std::function<void()>& act);
  // Adds the participant if new; fills in the row's id.
  void add_session(SessionRow& session);
  // Returns once the trial is on the disk, in the file of that name, and its answer in the journal.
  // After a StoreError the same record may be added again: what was done of it is not repeated.
  // Throws StoreError also if the participant has answered this trial already, in any session, and
  // if study.db was deleted or moved; deleted, all that it held has been written to a new one.
  SaveOutcome add_trial(const TrialRecord& record);

  void add_session_events(const std::vector<SessionEventRow>& events);
  void add_form(const std::vector<FormAnswerRow>& answers);
  void add_operator_action(const OperatorActionRow& action);
  // Supersedes the participant's answer to that trial. Throws StoreError if there is none.
  void add_correction(const CorrectionRow& correction, const OperatorActionRow& action);

  // The participant's latest session, or the latest in which there was a trial.
  std::optional<SessionRow> latest_session(const std::string& participant_id,
                                           bool has_trials = false);
  std::vector<std::string> participant_ids();
  // The session in which a trial of that number was presented to the participant last.
  std::optional<std::int64_t> session_of_trial(const std::string& participant_id, int number);
  // Numbers of the trials that the participant has answered, in any session.
  std::vector<int> answered_trials(const std::string& participant_id);
  // The number of presentations of each trial, by its number.
  std::map<int, int> presentations(const std::string& participant_id);
  // Trials that were presented, timed out or skipped, and not answered later; in the order in which
  // that was last.
  std::vector<UnansweredTrial> unanswered_trials(const std::string& participant_id);
  // In the order in which they were stored.
  std::vector<FormAnswerRow> form_answers_of(const std::string& participant_id);
  // The reasons of exclusion by participant.
  std::map<std::string, std::string> excluded_participants();
  // The participant's, without corrections, in the order given.
  std::vector<JournalledAnswer> answers_as_given(const std::string& participant_id);
  AlternativesOfTrials alternatives();
  std::vector<SessionRow> sessions();
  JournalEntries entries_for_journal();
  // A SELECT; queries for reports are in study_queries.hpp.
  Statement query(const std::string& select) { return Statement{database_, select}; }
  // Its rows, each shown as it comes.
  void each_row(const std::string& select, const std::function<void(Statement&)>& show);
  // All that `read` reads is of one moment, whatever a session adds meanwhile.
  void in_read_transaction(const std::function<void()>& read);
  std::vector<std::int64_t> trials();  // the ids of all, whatever became of them
  // Every tick of a trial, in order; empty if there is no such trial.
  std::vector<core::TraceSample> trace(std::int64_t trial_id);
  // What an actuator was given in a trial; unset where that is not stored.
  struct StoredActuator {
    ActuatorRow row;
    ActuatorTrace trace;
  };
  std::optional<StoredActuator> actuator(std::int64_t trial_id);
  // Whether it is stored of any trial; whether this store can hold it.
  bool has_actuators();
  bool has_tables_of_actuators();

 private:
  Store(Database database, std::optional<Journal> journal)
      : database_{std::move(database)}, journal_{std::move(journal)} {}
  void check_is_sound();
  void check_version();
  void check_schema();
  bool has_columns_of_groups();
  bool has_columns_of_planned_sessions();
  void add_participant(const SessionRow& session);
  std::string session_columns();
  void create(const StudyRow& study);
  void insert_trial(const TrialRecord& record);
  void rewrite_database();
  void check_is_in_place(const TrialRow& trial);
  void add_to_batch(const TrialRecord& record);
  void in_batch(const std::function<void()>& act);
  void commit_batch();
  void add_to_journal(const TrialRecord& record);
  void journal_failed_calls();
  void journal(const std::set<std::int64_t>& session_ids_of_entries, const JournalEntries& entries);
  void journal_sessions();
  void insert_action(const OperatorActionRow& action);
  int insert_correction(const CorrectionRow& correction);  // which of the trial's, from 1
  void add_and_journal(JournalEntries entries, std::int64_t session_id,
                       const std::function<void(JournalEntries&)>& insert);
  void check_has_not_moved();
  int next_participant_index(Mode mode);
  std::vector<AlternativeRow> alternatives_of(std::int64_t trial_id);
  AlternativesOfTrials alternatives_where(const char* condition,
                                          std::optional<std::int64_t> trial_id);
  std::vector<JournalledAnswer> answers_for_journal();
  std::vector<JournalledAnswer> journalled_answers(Statement& row);
  std::vector<CorrectionRow> corrections_for_journal();
  std::vector<FormAnswerRow> forms_for_journal();
  void insert_form_answer(const FormAnswerRow& answer);
  std::vector<OperatorActionRow> actions_for_journal();
  SessionRow session_of(std::int64_t session_id);
  std::set<std::int64_t> session_ids();
  StudyRow study_without_surfaces();
  std::vector<SurfaceRow> surfaces();
  void add_surfaces(const StudyRow& study);
  void check_surfaces(const StudyRow& study);  // by their hashes
  void check_is_of_journal(const JournalSummary& journal);
  bool is_empty();
  void create_or_check(const StudyRow& study, const AcceptText& accept);
  std::optional<std::string> latest_protocol_text();
  void check_not_answered(const TrialRow& trial);
  void add_alternatives(std::int64_t trial_id, const std::vector<AlternativeRow>& alternatives);
  void add_actuator(std::int64_t trial_id, const TrialRecord& record);
  void add_details(std::int64_t trial_id, const TrialRecord& record);
  Database database_;
  std::optional<Journal> journal_;
  std::optional<std::string> changed_protocol_text_;  // of the sessions that this one adds
  bool confirms_{true};
  // Of the open transaction while nothing is confirmed.
  struct Batch {
    bool is_open{false};
    int trials{0};
    std::vector<JournalledAnswer> answers;
  };
  Batch batch_;
  std::string batch_failure_;                               // why what it held is lost
  std::optional<std::array<std::int64_t, 3>> unconfirmed_;  // a trial that is committed, no more
  // Committed by a call that then failed.
  struct FailedCall {
    std::vector<std::string> lines;  // as given
    JournalEntries entries;          // as inserted
    std::int64_t session_id{};
    bool is_journalled{false};
  };
  std::vector<FailedCall> failed_calls_;
};
}  // namespace tapstudy::results
