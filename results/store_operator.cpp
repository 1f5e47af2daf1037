// What the operator adds to a study, and what follows from it.
#include <fmt/format.h>

#include <algorithm>

#include "results/store.hpp"
#include "results/store_error.hpp"
namespace tapstudy::results {
void Store::journal(const JournalEntries& entries, std::int64_t session_id) {
  if (!journal_) {
    return;
  }
  const auto of_study = [this] { return study(); };
  if (!journal_->complete(of_study, {session_of(session_id)}, entries)) {
    journal_->complete(of_study, sessions(), entries_for_journal());
  }
}

void Store::insert_action(const OperatorActionRow& action) {
  Statement{database_,
            "INSERT INTO operator_action (session_id, t_s, action, number, detail) "
            "VALUES (?, ?, ?, ?, ?)"}
      .bind(action.session_id)
      .bind(action.t_s)
      .bind(action.action)
      .bind(action.number)
      .bind(action.detail)
      .finish();
}

// Rows that are in the database, but whose journalling failed, are journalled by the next call of
// any kind; the call that is made again for them finds them here and inserts nothing.
void Store::add_and_journal(JournalEntries entries, std::int64_t session_id,
                            const std::function<void(JournalEntries&)>& insert) {
  const std::vector<std::string> what = to_lines(entries);
  if (std::ranges::find(failed_calls_, what, &FailedCall::lines) == failed_calls_.end()) {
    Transaction all{database_};
    insert(entries);
    all.commit();
    failed_calls_.push_back({what, std::move(entries), session_id});
  }
  if (journal_) {
    check_has_not_moved();
  }
  for (FailedCall& one : failed_calls_) {
    if (!one.is_journalled) {
      journal(one.entries, one.session_id);
      one.is_journalled = true;
    }
  }
  std::erase_if(failed_calls_, [&](const FailedCall& one) { return one.lines == what; });
}

void Store::add_operator_action(const OperatorActionRow& action) {
  add_and_journal({.actions = {action}}, action.session_id,
                  [&](JournalEntries& /*entries*/) { insert_action(action); });
}

// The times are those of the answer that the participant gave.
int Store::insert_correction(const CorrectionRow& correction) {
  Statement{database_,
            "INSERT INTO response (trial_id, response, is_correct, response_time_s, "
            "time_from_first_contact_s, confidence, supersedes, given_by) "
            "SELECT trial_id, ?, ?, response_time_s, time_from_first_contact_s, confidence, "
            "response_id, ? FROM current_response JOIN trial USING (trial_id) "
            "WHERE session_id = ? AND number = ? AND status = 'answered'"}
      .bind(correction.response)
      .bind(correction.is_correct)
      .bind(to_text(correction.given_by))
      .bind(correction.session_id)
      .bind(correction.number)
      .finish();
  Statement changes{database_, "SELECT changes()"};
  changes.step();
  if (changes.integer(0) != 1) {
    throw StoreError{fmt::format("{}: trial {} has no answer that could be corrected",
                                 database_.file(), correction.number)};
  }
  Statement count{database_,
                  "SELECT count(supersedes) FROM response JOIN trial USING (trial_id) "
                  "WHERE session_id = ? AND number = ?"};
  count.bind(correction.session_id).bind(correction.number).step();
  return static_cast<int>(count.integer(0));
}

void Store::add_correction(const CorrectionRow& correction, const OperatorActionRow& action) {
  add_and_journal({.corrections = {correction}, .actions = {action}}, correction.session_id,
                  [&](JournalEntries& entries) {
                    entries.corrections.front().ordinal = insert_correction(correction);
                    insert_action(action);
                  });
}

std::map<std::string, std::string> Store::excluded_participants() {
  Statement row{database_, "SELECT participant_id, exclusion_reason FROM excluded_participant"};
  std::map<std::string, std::string> excluded;
  while (row.step()) {
    excluded[row.text(0)] = row.text(1);
  }
  return excluded;
}

JournalEntries Store::entries_for_journal() {
  return {answers_for_journal(), corrections_for_journal(), actions_for_journal(),
          forms_for_journal()};
}

std::vector<CorrectionRow> Store::corrections_for_journal() {
  Statement row{database_,
                "SELECT session_id, number, response, is_correct, given_by, "
                "row_number() OVER (PARTITION BY trial_id ORDER BY response_id) FROM response "
                "JOIN trial USING (trial_id) WHERE supersedes IS NOT NULL ORDER BY response_id"};
  std::vector<CorrectionRow> corrections;
  while (row.step()) {
    corrections.push_back({row.integer(0), row.small_integer(1), row.text(2), row.optional_flag(3),
                           given_by_from(row.text(4)), row.small_integer(5)});
  }
  return corrections;
}

std::vector<OperatorActionRow> Store::actions_for_journal() {
  Statement row{database_,
                "SELECT session_id, t_s, action, number, detail FROM operator_action "
                "ORDER BY action_id"};
  std::vector<OperatorActionRow> actions;
  while (row.step()) {
    actions.push_back({row.integer(0), row.real(1), row.text(2), row.optional_int(3), row.text(4)});
  }
  return actions;
}
}  // namespace tapstudy::results
