#include "results/participant_courses.hpp"
namespace tapstudy::results {
namespace {
void add_presentations(Store& store, ParticipantCourseRow& course) {
  Statement row = store.query(
      "WITH own AS (SELECT trial.* FROM trial JOIN session USING (session_id) "
      "  WHERE participant_id = ? AND NOT is_practice) "
      "SELECT count(*) FILTER (WHERE status = 'answered'), "
      "  count(*) FILTER (WHERE status = 'interrupted'), "
      "  count(*) FILTER (WHERE status = 'repeated'), "
      "  count(*) FILTER (WHERE status = 'skipped'), "
      "  count(*) FILTER (WHERE status = 'timed_out'), "
      "  count(DISTINCT number) FILTER (WHERE status IN ('skipped', 'timed_out') "
      "    AND number NOT IN (SELECT number FROM own WHERE status = 'answered')), "
      "  count(*) FILTER (WHERE status = 'answered' AND current_response.response IS NOT "
      "    first.response), "
      "  count(*) FILTER (WHERE status = 'answered' AND is_catch), "
      "  count(*) FILTER (WHERE status = 'answered' AND is_catch "
      "    AND current_response.is_correct), "
      "  count(*) FILTER (WHERE status = 'answered' AND current_response.response IS NOT "
      "    first.response AND current_response.is_correct AND NOT first.is_correct) "
      "FROM own LEFT JOIN current_response USING (trial_id) "
      "LEFT JOIN response AS first ON first.trial_id = own.trial_id "
      "  AND first.supersedes IS NULL");
  row.bind(course.participant_id).step();
  course.answered = row.small_integer(0);
  course.interrupted = row.small_integer(1);
  course.repeated = row.small_integer(2);
  course.skipped = row.small_integer(3);
  course.timed_out = row.small_integer(4);
  course.given_up = row.small_integer(5);
  course.corrected = row.small_integer(6);
  course.catch_trials = row.small_integer(7);
  course.catch_right = row.small_integer(8);
  course.corrected_to_right = row.small_integer(9);
}

void add_loop(Store& store, ParticipantCourseRow& course) {
  Statement row = store.query(
      "SELECT coalesce(sum(ticks), 0), coalesce(sum(late), 0), "
      "  coalesce(sum(skipped), 0), coalesce(sum(saturated), 0), "
      "  coalesce(sum(dropped_samples), 0), coalesce(max(lateness_p999_s), 0), "
      "  coalesce(max(worst_lateness_s), 0), "
      "  coalesce(sum((SELECT count(*) FROM event "
      "    WHERE event.trial_id = trial.trial_id AND kind = 'impact')), 0), "
      "  coalesce(sum((SELECT count(*) FROM event "
      "    WHERE event.trial_id = trial.trial_id AND kind = 'late_impact')), 0) "
      "FROM trial JOIN session USING (session_id) JOIN tick_statistics USING (trial_id) "
      "WHERE participant_id = ?");
  row.bind(course.participant_id).step();
  course.ticks = row.integer(0);
  course.late = row.integer(1);
  course.skipped_ticks = row.integer(2);
  course.saturated = row.integer(3);
  course.dropped_samples = row.integer(4);
  course.lateness_p999_s = row.real(5);
  course.worst_lateness_s = row.real(6);
  course.impacts = row.integer(7);
  course.late_impacts = row.integer(8);
}

void add_masking(Store& store, ParticipantCourseRow& course) {
  Statement row = store.query(
      "SELECT count(DISTINCT trial_id), "
      "  count(DISTINCT trial_id) FILTER (WHERE kind = 'masking'), "
      "  min(value) FILTER (WHERE kind = 'masking'), "
      "  max(value) FILTER (WHERE kind = 'masking'), "
      "  coalesce(sum(value) FILTER (WHERE kind = 'masking_underrun'), 0), "
      "  coalesce(sum(value) FILTER (WHERE kind = 'masking_cut'), 0), "
      "  count(DISTINCT trial_id) FILTER (WHERE kind = 'masking_lost') "
      "FROM trial JOIN session USING (session_id) LEFT JOIN event USING (trial_id) "
      "WHERE participant_id = ?");
  row.bind(course.participant_id).step();
  course.stored_trials = row.small_integer(0);
  course.masked_trials = row.small_integer(1);
  course.masking_low_db = row.optional_real(2);
  course.masking_high_db = row.optional_real(3);
  course.masking_gaps = row.integer(4);
  course.masking_cut_samples = row.integer(5);
  course.masking_lost = row.small_integer(6);
}

void add_form_items(Store& store, ParticipantCourseRow& course) {
  Statement row = store.query(
      "SELECT count(*), count(*) - count(answer) FROM form_answer "
      "JOIN session USING (session_id) WHERE participant_id = ?");
  row.bind(course.participant_id).step();
  course.form_items = row.small_integer(0);
  course.form_items_left_out = row.small_integer(1);
}
}  // namespace

std::vector<ParticipantCourseRow> participant_courses(Store& store) {
  Statement row = store.query(
      "SELECT participant_id, mode, exclusion_reason, "
      "  (SELECT count(*) FROM session "
      "    WHERE session.participant_id = participant.participant_id) "
      "FROM participant LEFT JOIN excluded_participant USING (participant_id) "
      "ORDER BY mode, participant_index");
  std::vector<ParticipantCourseRow> courses;
  while (row.step()) {
    ParticipantCourseRow course;
    course.participant_id = row.text(0);
    course.mode = mode_from(row.text(1));
    course.exclusion_reason = row.optional_text(2);
    course.sessions = row.small_integer(3);
    courses.push_back(course);
  }
  for (ParticipantCourseRow& course : courses) {
    add_presentations(store, course);
    add_loop(store, course);
    add_masking(store, course);
    add_form_items(store, course);
  }
  return courses;
}

std::map<std::string, BlockCourseRow> block_courses(Store& store, Mode mode) {
  Statement row = store.query(
      "SELECT block, participant_id, count(*), count(*) FILTER (WHERE EXISTS (SELECT 1 FROM event "
      "  WHERE event.trial_id = trial.trial_id AND kind = 'masking')) "
      "FROM trial JOIN session USING (session_id) JOIN participant USING (participant_id) "
      "WHERE status = 'answered' AND mode = ? "
      "  AND participant_id NOT IN (SELECT participant_id FROM excluded_participant) "
      "  AND participant_id IN (SELECT participant_id FROM trial JOIN session USING (session_id) "
      "    WHERE status = 'answered' AND NOT is_practice AND NOT is_catch) "
      "GROUP BY block, participant_id");
  row.bind(to_text(mode));
  std::map<std::string, BlockCourseRow> courses;
  while (row.step()) {
    BlockCourseRow& course = courses[row.text(0)];
    course.participants.insert(row.text(1));
    course.answered += row.small_integer(2);
    course.masked += row.small_integer(3);
  }
  return courses;
}
}  // namespace tapstudy::results
