#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
namespace tapstudy::results {
// PRAGMA application_id of a study's database ("taps") and PRAGMA user_version of its schema.
inline constexpr int application_id = 0x74617073;
inline constexpr int schema_version = 14;
// Stores of these lack what their protocols did not have: the participants' groups, a protocol's
// sessions and its changed texts; before 14 what an actuator was given was not stored. They are
// read, and go on, as they are.
inline constexpr int first_schema_version = 11;
inline constexpr int first_version_with_groups = 12;
inline constexpr int first_version_with_planned_sessions = 13;
inline constexpr int first_version_with_actuators = 14;
inline constexpr bool is_known_schema(std::int64_t version) {
  return version >= first_schema_version && version <= schema_version;
}

// Tables hold each fact once; the views v_… are for reading by hand and for exports.
inline constexpr const char* schema_sql = R"sql(
CREATE TABLE study (
  id INTEGER PRIMARY KEY CHECK (id = 1),
  title TEXT NOT NULL,
  protocol_file TEXT NOT NULL,
  protocol_text TEXT NOT NULL,
  protocol_sha256 TEXT NOT NULL,
  created_utc TEXT NOT NULL
) STRICT;
CREATE TABLE surface (
  file TEXT PRIMARY KEY,            -- as the protocol names it
  sha256 TEXT NOT NULL,             -- of the file as it was
  size INTEGER NOT NULL,            -- in bytes, before compression
  zstd BLOB NOT NULL                -- the file whole, one Zstandard frame
) STRICT;
CREATE TABLE participant (
  participant_id TEXT PRIMARY KEY,
  mode TEXT NOT NULL CHECK (mode IN ('real', 'pilot', 'simulated')),
  participant_index INTEGER NOT NULL,  -- from 0 in each mode
  order_index INTEGER NOT NULL,        -- which of the balanced orders, from 0
  group_name TEXT,                     -- NULL: the protocol has no groups
  group_assignment TEXT CHECK (group_assignment IN ('balanced', 'given')),
  CHECK ((group_name IS NULL) = (group_assignment IS NULL)),
  UNIQUE (mode, participant_index)
) STRICT;
CREATE TABLE session (
  session_id INTEGER PRIMARY KEY,
  participant_id TEXT NOT NULL REFERENCES participant,
  planned_session TEXT,             -- which of the protocol's; NULL: it has none
  protocol_text TEXT,               -- NULL: the study's; else the same but for texts for people
  seed TEXT NOT NULL,               -- unsigned 64 bit, decimal
  planned_order TEXT NOT NULL,
  language TEXT NOT NULL,           -- of what the participant read
  resumes INTEGER REFERENCES session,
  rate_hz REAL NOT NULL,
  rig_text TEXT NOT NULL,
  device TEXT NOT NULL,
  scheduler TEXT NOT NULL,
  doctor TEXT NOT NULL,             -- JSON; empty where time is virtual
  program_version TEXT NOT NULL,
  git_hash TEXT NOT NULL,
  compiler TEXT NOT NULL,
  started_utc TEXT NOT NULL
) STRICT;
CREATE INDEX session_of_participant ON session (participant_id);
CREATE TABLE trial (
  trial_id INTEGER PRIMARY KEY,
  session_id INTEGER NOT NULL REFERENCES session,
  number INTEGER NOT NULL,
  attempt INTEGER NOT NULL,
  block TEXT NOT NULL,
  task TEXT NOT NULL,
  is_practice INTEGER NOT NULL,
  is_catch INTEGER NOT NULL,        -- there to see who attends
  presented TEXT NOT NULL CHECK (presented IN ('virtual', 'real')),  -- rendered, or a real plate
  repetition INTEGER NOT NULL,
  status TEXT NOT NULL CHECK (status IN ('answered', 'interrupted', 'repeated',
    'timed_out', 'skipped')),
  duration_s REAL NOT NULL,
  UNIQUE (session_id, number, attempt)
) STRICT;
CREATE TABLE alternative (
  trial_id INTEGER NOT NULL REFERENCES trial,
  position INTEGER NOT NULL,
  label TEXT NOT NULL,
  stimulus TEXT NOT NULL,
  is_comparison INTEGER NOT NULL,   -- not the standard that it is compared with
  PRIMARY KEY (trial_id, position)
) STRICT;
CREATE TABLE axis_value (           -- as presented, of stimuli that vary
  trial_id INTEGER NOT NULL REFERENCES trial,
  position INTEGER NOT NULL,        -- of the alternative
  axis TEXT NOT NULL,
  value REAL NOT NULL,              -- in the unit that ends the axis's name
  PRIMARY KEY (trial_id, position, axis)
) STRICT;
CREATE TABLE response (
  response_id INTEGER PRIMARY KEY,
  trial_id INTEGER NOT NULL REFERENCES trial,
  response TEXT NOT NULL,
  is_correct INTEGER,               -- NULL where no answer is right
  response_time_s REAL NOT NULL,
  time_from_first_contact_s REAL,
  confidence INTEGER,               -- from 1; NULL where it was not asked or not given
  supersedes INTEGER UNIQUE REFERENCES response,  -- a correction: the response that was wrong
  given_by TEXT NOT NULL CHECK (given_by IN ('participant', 'operator'))
) STRICT;
CREATE UNIQUE INDEX first_response_of_trial ON response (trial_id) WHERE supersedes IS NULL;
CREATE INDEX response_of_trial ON response (trial_id);
CREATE VIEW current_response AS SELECT * FROM response WHERE response_id NOT IN
  (SELECT supersedes FROM response WHERE supersedes IS NOT NULL);
CREATE TABLE event (
  trial_id INTEGER NOT NULL REFERENCES trial,
  t_s REAL NOT NULL,
  kind TEXT NOT NULL,
  value REAL NOT NULL
) STRICT;
CREATE INDEX event_of_trial ON event (trial_id);
CREATE TABLE session_event (
  session_id INTEGER NOT NULL REFERENCES session,
  t_s REAL NOT NULL,                -- of a monotonic clock, from the session's begin
  state TEXT NOT NULL,              -- that was entered
  number INTEGER,                   -- of the trial; NULL between trials
  detail TEXT NOT NULL
) STRICT;
CREATE INDEX event_of_session ON session_event (session_id);
CREATE TABLE form_answer (
  session_id INTEGER NOT NULL REFERENCES session,
  t_s REAL NOT NULL,                -- when the form was sent; as in session_event
  form TEXT NOT NULL,
  asked TEXT NOT NULL,              -- session begin, session end, or the block that it came after
  item TEXT NOT NULL,
  answer TEXT,                      -- NULL: left out; scales from 0 to 1, steps from 1
  PRIMARY KEY (session_id, form, asked, item)
) STRICT;
CREATE TABLE operator_action (
  action_id INTEGER PRIMARY KEY,
  session_id INTEGER NOT NULL REFERENCES session,
  t_s REAL NOT NULL,                -- as in session_event
  action TEXT NOT NULL,             -- pause, note, correct, exclude …
  number INTEGER,                   -- of the trial that it concerns; NULL between trials
  detail TEXT NOT NULL              -- note, reason, the corrected answer
) STRICT;
CREATE INDEX action_of_session ON operator_action (session_id);
CREATE TABLE trace_chunk (
  trial_id INTEGER NOT NULL REFERENCES trial,
  first_tick INTEGER NOT NULL,
  ticks INTEGER NOT NULL,
  codec TEXT NOT NULL,
  bytes BLOB NOT NULL,
  PRIMARY KEY (trial_id, first_tick)
) STRICT;
CREATE TABLE actuator (              -- of a trial, what its samples follow from beside the trace
  trial_id INTEGER NOT NULL UNIQUE REFERENCES trial,
  rate_hz REAL NOT NULL,
  delay_s REAL NOT NULL,            -- from a tick to its sound
  full_scale_n REAL NOT NULL,
  last_n REAL NOT NULL,             -- the sample before the first
  mean_square_n2 REAL NOT NULL,     -- of the limiter, before the first
  ticks_lost INTEGER NOT NULL,      -- on their way to the card's thread
  dropped_periods INTEGER NOT NULL  -- the last ones
) STRICT;
CREATE TABLE actuator_chunk (
  trial_id INTEGER NOT NULL REFERENCES trial,
  first_period INTEGER NOT NULL,
  periods INTEGER NOT NULL,
  samples INTEGER NOT NULL,
  codec TEXT NOT NULL,
  bytes BLOB NOT NULL,
  PRIMARY KEY (trial_id, first_period)
) STRICT;
CREATE TABLE tick_statistics (
  trial_id INTEGER PRIMARY KEY REFERENCES trial,
  ticks INTEGER NOT NULL,
  late INTEGER NOT NULL,
  skipped INTEGER NOT NULL,
  saturated INTEGER NOT NULL,
  dropped_samples INTEGER NOT NULL,
  lateness_p999_s REAL NOT NULL,
  worst_lateness_s REAL NOT NULL,
  fault TEXT NOT NULL
) STRICT;
CREATE VIEW excluded_participant AS SELECT participant_id, detail AS exclusion_reason FROM
  (SELECT participant_id, action, detail,
     row_number() OVER (PARTITION BY participant_id ORDER BY action_id DESC) AS from_latest
   FROM operator_action JOIN session USING (session_id)
   WHERE action IN ('exclude', 'include'))
  WHERE from_latest = 1 AND action = 'exclude';
CREATE VIEW v_sessions AS SELECT session_id, participant_id, group_name, planned_session, group_assignment, participant_index, order_index, mode,
    exclusion_reason IS NOT NULL AS is_excluded, exclusion_reason, resumes, started_utc, language,
    rate_hz, device, scheduler, program_version, git_hash, compiler, seed, planned_order,
    rig_text, protocol_text, doctor
  FROM session JOIN participant USING (participant_id)
  LEFT JOIN excluded_participant USING (participant_id);
CREATE VIEW trial_context AS SELECT trial_id, session_id, participant_id, group_name, planned_session, mode, is_excluded,
    exclusion_reason, block, task, number, attempt, repetition, is_practice, is_catch, presented,
    status, duration_s,
    CASE (SELECT count(*) FROM alternative WHERE alternative.trial_id = trial.trial_id)
      WHEN 1 THEN (SELECT stimulus FROM alternative WHERE alternative.trial_id = trial.trial_id)
    END AS stimulus               -- NULL if there were several
  FROM trial JOIN v_sessions USING (session_id);
-- An alternative is visited from the switch to it until the next switch or the trial's end.
CREATE VIEW v_visits AS SELECT trial_id, session_id, participant_id, group_name, planned_session, mode, is_excluded, exclusion_reason, block, task,
    number, attempt, is_practice, is_catch, presented, status, visit, visited.position AS position, label,
    alternative.stimulus AS stimulus, begin_s,
    coalesce(next_s, duration_s) AS end_s, coalesce(next_s, duration_s) - begin_s AS dwell_s
  FROM (SELECT trial_id, CAST(value AS INTEGER) AS position, t_s AS begin_s,
      row_number() OVER (PARTITION BY trial_id ORDER BY t_s) AS visit,
      lead(t_s) OVER (PARTITION BY trial_id ORDER BY t_s) AS next_s
    FROM event WHERE kind = 'switch') AS visited
  JOIN trial_context USING (trial_id) JOIN alternative USING (trial_id, position);
CREATE VIEW v_stimuli AS SELECT trial_id, session_id, participant_id, group_name, planned_session, mode, is_excluded, exclusion_reason, block, task,
    number, attempt, is_practice, is_catch, presented, status, alternative.position AS position, label,
    alternative.stimulus AS stimulus, is_comparison,
    (SELECT group_concat(axis || '=' || value, ' ') FROM axis_value
      WHERE axis_value.trial_id = alternative.trial_id
        AND axis_value.position = alternative.position) AS axis_values,
    coalesce(visits, 0) AS visits, coalesce(total_dwell_s, 0.0) AS total_dwell_s
  FROM alternative JOIN trial_context USING (trial_id)
  LEFT JOIN (SELECT trial_id, position, count(*) AS visits,
      sum(dwell_s) AS total_dwell_s FROM v_visits GROUP BY trial_id, position)
    USING (trial_id, position);
CREATE VIEW v_answers AS SELECT response_id, trial_id, session_id, participant_id, group_name, planned_session, mode, is_excluded, exclusion_reason, block, task,
    number, attempt, is_practice, is_catch, presented, status,
    stimulus, response, is_correct, response_time_s, time_from_first_contact_s, confidence,
    given_by, supersedes, supersedes IS NOT NULL AS is_correction,
    response_id NOT IN (SELECT supersedes FROM response WHERE supersedes IS NOT NULL)
      AS is_current
  FROM response JOIN trial_context USING (trial_id);
CREATE VIEW v_trials AS SELECT trial_context.*, current_response.response AS response,
    current_response.is_correct AS is_correct,
    current_response.supersedes IS NOT NULL AS is_corrected,
    first.response AS first_response, first.is_correct AS first_is_correct,
    current_response.given_by AS given_by, current_response.confidence AS confidence,
    current_response.response_time_s AS response_time_s,
    current_response.time_from_first_contact_s AS time_from_first_contact_s,
    (SELECT min(t_s) FROM event WHERE event.trial_id = trial_context.trial_id
      AND kind = 'contact') AS first_contact_s,
    (SELECT count(*) FROM event WHERE event.trial_id = trial_context.trial_id
      AND kind = 'contact') AS contacts,
    (SELECT count(*) FROM event WHERE event.trial_id = trial_context.trial_id
      AND kind = 'impact') AS impacts,
    (SELECT count(*) FROM event WHERE event.trial_id = trial_context.trial_id
      AND kind = 'late_impact') AS late_impacts,
    (SELECT max(value) FROM event WHERE event.trial_id = trial_context.trial_id
      AND kind = 'impact') AS max_impact_speed_m_s,
    ticks, late AS late_ticks, skipped AS skipped_ticks, saturated AS saturated_ticks,
    dropped_samples, lateness_p999_s, worst_lateness_s, fault
  FROM trial_context LEFT JOIN current_response USING (trial_id)
  LEFT JOIN response AS first ON first.trial_id = trial_context.trial_id
    AND first.supersedes IS NULL
  LEFT JOIN tick_statistics ON tick_statistics.trial_id = trial_context.trial_id;
)sql";

// What of the above the schemas before a version lack.
struct LaterSchemaText {
  int since;
  std::string_view text;
};
constexpr std::string_view part_of_schema(std::string_view from, std::string_view until) {
  const std::string_view all = schema_sql;
  const std::size_t begin = all.find(from);
  return all.substr(begin, all.find(until) - begin);
}
inline constexpr std::array<LaterSchemaText, 10> later_schema_texts{{
    {first_version_with_actuators,
     part_of_schema("CREATE TABLE actuator (", "CREATE TABLE tick_statistics (")},
    {first_version_with_groups,
     "  group_name TEXT,                     -- NULL: the protocol has no groups\n"},
    {first_version_with_groups,
     "  group_assignment TEXT CHECK (group_assignment IN ('balanced', 'given')),\n"},
    {first_version_with_groups, "  CHECK ((group_name IS NULL) = (group_assignment IS NULL)),\n"},
    {first_version_with_groups, "group_name, "},
    {first_version_with_groups, "group_assignment, "},
    {first_version_with_planned_sessions,
     "  planned_session TEXT,             -- which of the protocol's; NULL: it has none\n"},
    {first_version_with_planned_sessions,
     "  protocol_text TEXT,               -- NULL: the study's; else the same but for texts for "
     "people\n"},
    {first_version_with_planned_sessions, "planned_session, "},
    {first_version_with_planned_sessions, "protocol_text, "},
}};

inline std::string schema_sql_of(int version) {
  std::string sql = schema_sql;
  for (const LaterSchemaText& later : later_schema_texts) {
    const std::size_t size = later.text.size();
    for (auto at = sql.find(later.text); version < later.since && at != std::string::npos;
         at = sql.find(later.text)) {
      sql.erase(at, size);
    }
  }
  return sql;
}
}  // namespace tapstudy::results
