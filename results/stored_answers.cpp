#include "results/stored_answers.hpp"
namespace tapstudy::results {
std::vector<AnswerRow> stored_answers(Store& store) {
  Statement row = store.query(
      "SELECT participant_id, participant_index, order_index, mode, block, task, "
      "  is_practice, is_catch, number, "
      "  CASE WHEN EXISTS (SELECT 1 FROM alternative AS second "
      "    WHERE second.trial_id = trial.trial_id AND second.position = 1) THEN '' "
      "  ELSE (SELECT stimulus FROM alternative "
      "    WHERE alternative.trial_id = trial.trial_id AND position = 0) END, "
      "  response, is_correct, response_time_s, ticks, late, skipped, dropped_samples, "
      "  (SELECT count(*) FROM event WHERE event.trial_id = trial.trial_id "
      "    AND kind = 'impact'), "
      "  (SELECT count(*) FROM event WHERE event.trial_id = trial.trial_id "
      "    AND kind = 'late_impact'), "
      "  trial_id, repetition, time_from_first_contact_s, "
      "  (SELECT avg(value) FROM event WHERE event.trial_id = trial.trial_id "
      "    AND kind = 'impact'), "
      "  (SELECT coalesce(sum(CASE kind WHEN 'release' THEN t_s "
      "      WHEN 'contact' THEN -t_s END), 0) + "
      "    coalesce(sum((kind = 'contact') - (kind = 'release')), 0) * duration_s "
      "    FROM event WHERE event.trial_id = trial.trial_id "
      "    AND kind IN ('contact', 'release')), "
      "  (SELECT value FROM event WHERE event.trial_id = trial.trial_id "
      "    AND kind = 'setting' ORDER BY t_s, rowid LIMIT 1), "
      "  current_response.confidence "
      "FROM trial JOIN session USING (session_id) JOIN current_response USING (trial_id) "
      "JOIN tick_statistics USING (trial_id) JOIN participant USING (participant_id) "
      "WHERE status = 'answered' ORDER BY mode, participant_index, number");
  std::vector<AnswerRow> answers;
  while (row.step()) {
    answers.push_back({.participant_id = row.text(0),
                       .participant_index = row.small_integer(1),
                       .order_index = row.small_integer(2),
                       .mode = mode_from(row.text(3)),
                       .block = row.text(4),
                       .task = row.text(5),
                       .is_practice = row.flag(6),
                       .is_catch = row.flag(7),
                       .number = row.small_integer(8),
                       .stimulus = row.text(9),
                       .response = row.text(10),
                       .is_correct = row.optional_flag(11),
                       .response_time_s = row.real(12),
                       .ticks = row.integer(13),
                       .late = row.integer(14),
                       .skipped = row.integer(15),
                       .dropped_samples = row.integer(16),
                       .impacts = row.integer(17),
                       .late_impacts = row.integer(18),
                       .trial_id = row.integer(19),
                       .repetition = row.small_integer(20),
                       .time_from_first_contact_s = row.optional_real(21),
                       .mean_impact_speed_m_s = row.optional_real(22),
                       .contact_s = row.real(23),
                       .first_setting = row.optional_real(24),
                       .confidence = row.optional_int(25)});
  }
  return answers;
}

// A visit lasts from the switch to an alternative to the next switch or the end of the trial.
std::vector<VisitRow> stored_visits(Store& store) {
  Statement row = store.query(
      "SELECT participant_id, block, stimulus, count(*), sum(dwell_s) "
      "FROM v_visits JOIN participant USING (participant_id) "
      "WHERE status = 'answered' AND EXISTS (SELECT 1 FROM alternative AS second "
      "  WHERE second.trial_id = v_visits.trial_id AND second.position = 1) "
      "GROUP BY participant_id, block, stimulus "
      "ORDER BY v_visits.mode, participant_index, block, stimulus");
  std::vector<VisitRow> visits;
  while (row.step()) {
    visits.push_back({row.text(0), row.text(1), row.text(2), row.small_integer(3), row.real(4)});
  }
  return visits;
}

std::vector<VisitedPosition> visited_positions(Store& store) {
  Statement row = store.query(
      "SELECT trial_id, position FROM v_visits WHERE status = 'answered' AND EXISTS "
      "(SELECT 1 FROM alternative AS second WHERE second.trial_id = v_visits.trial_id "
      "AND second.position = 1) ORDER BY trial_id, visit");
  std::vector<VisitedPosition> visits;
  while (row.step()) {
    visits.push_back({row.integer(0), row.small_integer(1)});
  }
  return visits;
}

std::vector<FormAnswerRow> stored_form_answers(Store& store) {
  Statement row = store.query(
      "SELECT session_id, t_s, form, asked, item, answer FROM form_answer ORDER BY rowid");
  std::vector<FormAnswerRow> answers;
  while (row.step()) {
    answers.push_back(
        {row.integer(0), row.real(1), row.text(2), row.text(3), row.text(4), row.optional_text(5)});
  }
  return answers;
}

void each_rig_of_trial(Store& store,
                       const std::function<void(std::int64_t trial_id, std::string rig)>& take) {
  Statement row =
      store.query("SELECT trial_id, rig_text FROM trial JOIN session USING (session_id)");
  while (row.step()) {
    take(row.integer(0), row.text(1));
  }
}
}  // namespace tapstudy::results
