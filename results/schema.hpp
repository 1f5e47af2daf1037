#pragma once
namespace tapstudy::results {
// PRAGMA application_id of a study's database ("taps") and PRAGMA user_version of its schema.
inline constexpr int application_id = 0x74617073;
inline constexpr int schema_version = 9;

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
  UNIQUE (mode, participant_index)
) STRICT;
CREATE TABLE session (
  session_id INTEGER PRIMARY KEY,
  participant_id TEXT NOT NULL REFERENCES participant,
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
)sql";
}  // namespace tapstudy::results
