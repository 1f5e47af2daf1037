#include "results/store/row_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "core/text/plain_text.hpp"
namespace tapstudy::results {
namespace {
// SELECTs what breaks the rule, a text a row.
struct Rule {
  const char* sentence;
  const char* breaks;
};

constexpr std::array rules{
    Rule{"the database is whole, with its indices and constraints",
         "SELECT integrity_check FROM pragma_integrity_check(3) WHERE integrity_check <> 'ok'"},
    Rule{"there is one study",
         "SELECT studies || ' of them' FROM (SELECT count(*) AS studies FROM study) WHERE studies "
         "<> 1"},
    Rule{"every participant has a session",
         "SELECT participant_id FROM participant "
         "WHERE participant_id NOT IN (SELECT participant_id FROM session)"},
    Rule{"a session goes on with an earlier one of the same participant",
         "SELECT 'session ' || later.session_id FROM session AS later "
         "JOIN session AS earlier ON earlier.session_id = later.resumes "
         "WHERE earlier.session_id >= later.session_id "
         "OR earlier.participant_id <> later.participant_id"},
    Rule{
        "yes and no are 1 and 0",
        "SELECT 'trial ' || trial_id FROM trial WHERE is_practice NOT IN (0, 1) "
        "OR is_catch NOT IN (0, 1) "
        "UNION ALL SELECT 'trial ' || trial_id FROM alternative WHERE is_comparison NOT IN (0, 1) "
        "UNION ALL SELECT 'response ' || response_id FROM response WHERE is_correct NOT IN (0, 1)"},
    Rule{"counts and times are not negative, numbers are from 1",
         "SELECT 'participant ' || participant_id FROM participant "
         "WHERE participant_index NOT BETWEEN 0 AND 0x7fffffff "
         "OR order_index NOT BETWEEN 0 AND 0x7fffffff "
         "UNION ALL SELECT 'session ' || session_id FROM session "
         "WHERE NOT (rate_hz > 0 AND rate_hz < 1e9) "
         "UNION ALL SELECT 'trial ' || trial_id FROM trial "
         "WHERE number NOT BETWEEN 1 AND 0x7fffffff OR attempt NOT BETWEEN 1 AND 0x7fffffff "
         "OR repetition NOT BETWEEN 0 AND 0x7fffffff OR NOT (duration_s >= 0 AND duration_s < 1e9) "
         "UNION ALL SELECT 'trial ' || trial_id FROM alternative "
         "WHERE position NOT BETWEEN 0 AND 0x7fffffff "
         "UNION ALL SELECT 'response ' || response_id FROM response "
         "WHERE confidence NOT BETWEEN 1 AND 0x7fffffff "
         "OR NOT (response_time_s >= 0 AND response_time_s < 1e9) "
         "UNION ALL SELECT 'event of trial ' || trial_id FROM event "
         "WHERE NOT (t_s >= 0 AND t_s < 1e9 AND abs(value) < 1e300) "
         "UNION ALL SELECT 'ticks of trial ' || trial_id FROM tick_statistics "
         "WHERE min(ticks, late, skipped, saturated, dropped_samples, lateness_p999_s, "
         "worst_lateness_s) < 0 OR NOT max(lateness_p999_s, worst_lateness_s) < 1e9"},
    Rule{"an event is of a known kind",
         "SELECT DISTINCT kind FROM event WHERE kind NOT IN ('switch', 'contact', 'impact', "
         "'late_impact', 'release', 'untraced', 'setting', 'interval', 'interval_end', "
         "'interval_replay', 'scripted_taps', 'masking', 'masking_underrun', 'masking_cut', "
         "'masking_lost', 'actuator', 'actuator_jitter', 'actuator_rate_error', "
         "'actuator_underrun', 'actuator_limited', 'actuator_lost')"},
    Rule{"no event stands twice",  // a person can set, set back and set again within one tick
         "SELECT kind || ' of trial ' || trial_id FROM event WHERE kind <> 'setting' "
         "GROUP BY trial_id, t_s, kind, value HAVING count(*) > 1"},
    Rule{"settings are in the order of their times, and at one time differ from the one before",
         "SELECT DISTINCT 'trial ' || trial_id FROM (SELECT trial_id, t_s, value, "
         "  lag(t_s) OVER before AS before_s, lag(value) OVER before AS value_before "
         "  FROM event WHERE kind = 'setting' WINDOW before AS (PARTITION BY trial_id ORDER BY "
         "rowid)) "
         "WHERE t_s < before_s OR (t_s = before_s AND value = value_before)"},
    Rule{"no change of state stands twice",
         "SELECT state || ' of session ' || session_id FROM session_event "
         "GROUP BY session_id, t_s, state, number, detail HAVING count(*) > 1"},
    Rule{"contacts and releases take turns, from a contact on",
         "SELECT DISTINCT 'trial ' || trial_id FROM (SELECT trial_id, kind, "
         "  lag(kind, 1, 'release') OVER (PARTITION BY trial_id ORDER BY rowid) AS before "
         "  FROM event WHERE kind IN ('contact', 'release')) WHERE kind = before"},
    Rule{"a real plate is not rendered: it has no ticks",
         "SELECT 'trial ' || trial_id FROM trial JOIN tick_statistics USING (trial_id) "
         "WHERE presented = 'real' AND (max(ticks, late, skipped, saturated, dropped_samples) > 0 "
         "  OR max(lateness_p999_s, worst_lateness_s) > 0 "
         "  OR trial_id IN (SELECT trial_id FROM trace_chunk))"},
    Rule{"simulated time is never late, and loses nothing",
         "SELECT 'trial ' || trial_id FROM trial JOIN tick_statistics USING (trial_id) "
         "JOIN session USING (session_id) JOIN participant USING (participant_id) "
         "WHERE mode = 'simulated' AND (max(late, skipped, dropped_samples) > 0 "
         "  OR max(lateness_p999_s, worst_lateness_s) > 0)"},
    Rule{"ticks last as long as the trial, where time is simulated",
         "SELECT 'trial ' || trial_id FROM trial JOIN tick_statistics USING (trial_id) "
         "JOIN session USING (session_id) JOIN participant USING (participant_id) "
         "WHERE mode = 'simulated' AND presented = 'virtual' AND ticks > 0 "
         "AND abs(duration_s * rate_hz - (ticks - 1)) > 0.5"},
    Rule{"who answered has an answer",
         "SELECT 'trial ' || trial_id FROM trial WHERE status = 'answered' "
         "AND trial_id NOT IN (SELECT trial_id FROM response)"},
    // of sessions whose states are stored; a trial that is stopped has no such state
    Rule{"each way to end a trial is noted as often as trials ended so",
         "WITH ends AS (SELECT session_id, number, sum(state = 'saved') AS saved, "
         "    sum(state = 'repeated') AS repeated, sum(state = 'timed_out') AS timed_out, "
         "    sum(state = 'skipped') AS skipped, sum(state = 'faulted') AS faulted "
         "  FROM session_event WHERE number IS NOT NULL GROUP BY session_id, number), "
         "trials AS (SELECT session_id, number, sum(status = 'answered') AS answered, "
         "    sum(status = 'repeated') AS repeated, sum(status = 'timed_out') AS timed_out, "
         "    sum(status = 'skipped') AS skipped, sum(fault <> '') AS faulted, "
         "    max(attempt) AS attempts "
         "  FROM trial JOIN tick_statistics USING (trial_id) GROUP BY session_id, number) "
         "SELECT 'trial number ' || trials.number || ' of session ' || trials.session_id "
         "FROM trials LEFT JOIN ends USING (session_id, number) "
         "WHERE session_id IN (SELECT session_id FROM session_event) "
         "AND NOT coalesce(trials.repeated = ends.repeated AND trials.timed_out = ends.timed_out "
         "  AND trials.skipped = ends.skipped AND trials.faulted = ends.faulted "
         "  AND answered BETWEEN saved AND saved + ends.faulted, 0) "
         "UNION ALL SELECT 'trial number ' || number || ' of session ' || session_id FROM ends "
         "WHERE max(saved, repeated, timed_out, skipped, faulted) > 0 "
         "AND (session_id, number) NOT IN (SELECT session_id, number FROM trial)"},
    Rule{"a fault is noted in the words that the trial has",
         "SELECT 'trial ' || trial_id FROM trial JOIN tick_statistics USING (trial_id) "
         "WHERE fault <> '' AND session_id IN (SELECT session_id FROM session_event) "
         "AND NOT EXISTS (SELECT 1 FROM session_event AS noted WHERE noted.session_id = "
         "  trial.session_id AND noted.number = trial.number AND noted.state = 'faulted' "
         "  AND noted.detail = fault)"},
    Rule{"no presentation is counted that did not begin",
         "SELECT 'trial ' || trial_id FROM trial JOIN session USING (session_id) "
         "WHERE session_id IN (SELECT session_id FROM session_event) AND attempt > "
         "(SELECT count(*) FROM session_event AS noted JOIN session AS other USING (session_id) "
         "  WHERE other.participant_id = session.participant_id "
         "  AND noted.number = trial.number AND noted.state = 'exploring') "
         "AND NOT EXISTS (SELECT 1 FROM session AS silent "
         "  WHERE silent.participant_id = session.participant_id "
         "  AND silent.session_id NOT IN (SELECT session_id FROM session_event))"},
    // of one monotonic clock; an action may be added after the session, by the wall clock
    Rule{"times of a session are from its begin on",
         "SELECT state || ' of session ' || session_id || ' (row ' || rowid || ')' "
         "FROM session_event WHERE NOT (t_s >= 0 AND t_s < 1e9) "
         "UNION ALL SELECT form || ' of session ' || session_id FROM form_answer "
         "WHERE NOT (t_s >= 0 AND t_s < 1e9) "
         "UNION ALL SELECT 'action ' || action_id FROM operator_action "
         "WHERE NOT (t_s >= 0 AND t_s < 1e12)"},
    Rule{"a trial is over before what comes after it",
         "WITH presented AS (SELECT session_id, number, state, t_s, "
         "    lead(t_s) OVER (PARTITION BY session_id ORDER BY rowid) AS end_s "
         "  FROM session_event "
         "  WHERE state NOT IN ('exploring', 'answering', 'confirmed', 'confidence')), "
         "spans AS (SELECT session_id, number, sum(end_s - t_s) AS span_s FROM presented "
         "  WHERE state = 'ready' GROUP BY session_id, number HAVING count(*) = count(end_s)) "
         "SELECT 'trial ' || max(trial_id) || ' (' || round(sum(duration_s), 3) || ' s in ' || "
         "  round(span_s, 3) || ' s of session ' || session_id || ')' "
         "FROM trial JOIN spans USING (session_id, number) JOIN session USING (session_id) "
         "JOIN participant USING (participant_id) "
         "WHERE NOT (mode = 'simulated' AND presented = 'real') "  // no tick passes then
         "GROUP BY session_id, number HAVING sum(duration_s) > span_s + 1e-6"},
    Rule{"a questionnaire is sent while it is shown",
         "WITH shown AS (SELECT session_id, state, detail, t_s, "
         "    lead(t_s, 1, 1e9) OVER (PARTITION BY session_id ORDER BY rowid) AS end_s "
         "  FROM session_event) "
         "SELECT DISTINCT form || ' of session ' || session_id || ' at ' || round(t_s, 3) || ' s' "
         "FROM form_answer WHERE session_id IN (SELECT session_id FROM session_event) "
         "AND NOT EXISTS (SELECT 1 FROM shown WHERE shown.session_id = form_answer.session_id "
         "  AND state = 'form' AND detail = form "
         "  AND form_answer.t_s BETWEEN shown.t_s AND end_s)"},
    Rule{"a questionnaire that was answered was shown",
         "SELECT form || ' of session ' || session_id FROM (SELECT session_id, form, "
         "  count(DISTINCT asked) AS answered FROM form_answer GROUP BY session_id, form) AS given "
         "WHERE session_id IN (SELECT session_id FROM session_event) AND answered > "
         "(SELECT count(*) FROM session_event AS noted WHERE noted.session_id = given.session_id "
         "  AND noted.state = 'form' AND noted.detail = form)"},
};

std::vector<std::string> texts(Store& store, const std::string& select) {
  std::vector<std::string> found;
  store.each_row(select, [&](Statement& row) { found.push_back(row.text(0)); });
  return found;
}

void add_broken(const char* sentence, const std::vector<std::string>& rows,
                std::vector<std::string>& broken) {
  constexpr std::size_t max_named = 3;
  constexpr std::size_t longest = 60;
  if (rows.empty()) {
    return;
  }
  std::vector<std::string> named;
  for (std::size_t i = 0; i < std::min(rows.size(), max_named); ++i) {
    named.push_back(core::shortened(rows[i], longest));
  }
  broken.push_back(fmt::format(
      "{}: not {}{}", sentence, fmt::join(named, ", "),
      rows.size() > max_named ? fmt::format(" and {} more", rows.size() - max_named) : ""));
}

// Rows are added one after the other and never removed, nor does SQLite number them anew with gaps.
void add_gaps(Store& store, std::vector<std::string>& broken) {
  std::vector<std::string> tables;
  for (const std::string& table :
       texts(store, "SELECT name FROM sqlite_schema WHERE type = 'table'")) {
    std::vector<std::string> gap =
        texts(store, fmt::format("SELECT '{0}' FROM (SELECT count(*) AS rows, min(rowid) AS first, "
                                 "max(rowid) AS last FROM {0}) "
                                 "WHERE rows > 0 AND (first <> 1 OR last <> rows)",
                                 table));
    tables.insert(tables.end(), gap.begin(), gap.end());
  }
  add_broken("no row is missing between others of its table", tables, broken);
}
}  // namespace

std::vector<std::string> broken_rules(Store& store) {
  std::vector<std::string> broken;
  for (const Rule& rule : rules) {
    add_broken(rule.sentence, texts(store, rule.breaks), broken);
  }
  add_gaps(store, broken);
  return broken;
}
}  // namespace tapstudy::results
