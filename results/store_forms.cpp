// Answers to questionnaires.
#include "results/store.hpp"
namespace tapstudy::results {
void Store::insert_form_answer(const FormAnswerRow& answer) {
  Statement{database_, "INSERT INTO form_answer VALUES (?, ?, ?, ?, ?, ?)"}
      .bind(answer.session_id)
      .bind(answer.t_s)
      .bind(answer.form)
      .bind(answer.asked)
      .bind(answer.item)
      .bind(answer.answer)
      .finish();
}

void Store::add_form(const std::vector<FormAnswerRow>& answers) {
  if (answers.empty()) {
    return;
  }
  add_and_journal({.form_answers = answers}, answers.front().session_id,
                  [&](JournalEntries& /*entries*/) {
                    for (const FormAnswerRow& answer : answers) {
                      insert_form_answer(answer);
                    }
                  });
}

std::set<std::pair<std::string, std::string>> Store::filled_forms(
    const std::string& participant_id) {
  Statement row{database_,
                "SELECT DISTINCT form, asked FROM form_answer JOIN session USING (session_id) "
                "WHERE participant_id = ?"};
  row.bind(participant_id);
  std::set<std::pair<std::string, std::string>> filled;
  while (row.step()) {
    filled.emplace(row.text(0), row.text(1));
  }
  return filled;
}

std::vector<FormAnswerRow> Store::forms_for_journal() {
  Statement row{
      database_,
      "SELECT session_id, t_s, form, asked, item, answer FROM form_answer ORDER BY rowid"};
  std::vector<FormAnswerRow> answers;
  while (row.step()) {
    answers.push_back(
        {row.integer(0), row.real(1), row.text(2), row.text(3), row.text(4), row.optional_text(5)});
  }
  return answers;
}
}  // namespace tapstudy::results
