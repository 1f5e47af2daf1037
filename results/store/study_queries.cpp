#include "results/store/study_queries.hpp"

#include <fmt/format.h>

#include "results/store/form_amendments.hpp"
#include "results/store_error.hpp"
#include "results/traces/trace_codec.hpp"
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
      fmt::format("SELECT session_id, t_s, form, asked, item, answer FROM {} ORDER BY rowid",
                  current_form_answer));
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
      "    WHERE event.trial_id = trial.trial_id AND kind = 'late_impact')), 0), "
      "  count(*) FILTER (WHERE status = 'answered' AND skipped > ? * (ticks + skipped)) "
      "FROM trial JOIN session USING (session_id) JOIN tick_statistics USING (trial_id) "
      "WHERE participant_id = ?");
  row.bind(max_skipped_share).bind(course.participant_id).step();
  course.ticks = row.integer(0);
  course.late = row.integer(1);
  course.skipped_ticks = row.integer(2);
  course.saturated = row.integer(3);
  course.dropped_samples = row.integer(4);
  course.lateness_p999_s = row.real(5);
  course.worst_lateness_s = row.real(6);
  course.impacts = row.integer(7);
  course.late_impacts = row.integer(8);
  course.incomplete_trials = row.small_integer(9);
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
  Statement row =
      store.query(fmt::format("SELECT count(*), count(*) - count(answer) FROM {} "
                              "JOIN session USING (session_id) WHERE participant_id = ?",
                              current_form_answer));
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

void check_codec(const std::string& codec, const char* known, const std::string& what) {
  if (codec != known) {
    throw StoreError{
        fmt::format("{} is encoded as '{}' (this program reads {})", what, codec, known)};
  }
}

std::vector<core::TraceSample> decoded_chunk(Statement& row, int column, const std::string& what) {
  check_codec(row.text(column), trace_codec, what);
  return decode_trace(row.bytes(column + 2), static_cast<std::size_t>(row.integer(column + 1)),
                      what);
}

void each_trace_chunk(Store& store, const TakeChunk& take) {
  store.each_row(
      "SELECT trial_id, codec, ticks, bytes FROM trial CROSS JOIN trace_chunk USING (trial_id) "
      "ORDER BY session_id, number, attempt, first_tick",
      [&](Statement& row) {
        const std::int64_t trial_id = row.integer(0);
        take(trial_id, decoded_chunk(row, 1, fmt::format("trace of trial {}", trial_id)));
      });
}
}  // namespace tapstudy::results
