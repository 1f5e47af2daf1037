// What analysis reads: answered trials, and visits to alternatives.
#include "results/store.hpp"
namespace tapstudy::results {
std::vector<AnswerRow> Store::answers() {
  Statement row{database_,
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
                "WHERE status = 'answered' ORDER BY mode, participant_index, number"};
  std::vector<AnswerRow> answers;
  while (row.step()) {
    answers.push_back(
        {row.text(0),          row.small_integer(1), row.small_integer(2), mode_from(row.text(3)),
         row.text(4),          row.text(5),          row.flag(6),          row.flag(7),
         row.small_integer(8), row.text(9),          row.text(10),         row.optional_flag(11),
         row.real(12),         row.integer(13),      row.integer(14),      row.integer(15),
         row.integer(16),      row.integer(17),      row.integer(18),      row.integer(19)});
    AnswerRow& answer = answers.back();
    answer.repetition = row.small_integer(20);
    answer.time_from_first_contact_s = row.optional_real(21);
    answer.mean_impact_speed_m_s = row.optional_real(22);
    answer.contact_s = row.real(23);
    answer.confidence = row.optional_int(25);
    answer.first_setting = row.optional_real(24);
  }
  return answers;
}

// A visit lasts from the switch to an alternative to the next switch or the end of the trial.
std::vector<VisitRow> Store::visits() {
  Statement row{database_,
                "SELECT participant_id, block, stimulus, count(*), sum(dwell_s) "
                "FROM v_visits JOIN participant USING (participant_id) "
                "WHERE status = 'answered' AND EXISTS (SELECT 1 FROM alternative AS second "
                "  WHERE second.trial_id = v_visits.trial_id AND second.position = 1) "
                "GROUP BY participant_id, block, stimulus "
                "ORDER BY v_visits.mode, participant_index, block, stimulus"};
  std::vector<VisitRow> visits;
  while (row.step()) {
    visits.push_back({row.text(0), row.text(1), row.text(2), row.small_integer(3), row.real(4)});
  }
  return visits;
}
}  // namespace tapstudy::results
