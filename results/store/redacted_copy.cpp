#include "results/store/redacted_copy.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "results/store/schema.hpp"
#include "results/store/store.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;
using namespace std::string_literals;

// Copies the tables of schema.hpp, those that refer to others last. Columns are named, so that a
// new one is an error until somebody has decided about it; so are the states whose details the
// program writes. Temporary tables stay in memory.
constexpr const char* copy_sql = R"sql(
INSERT INTO study SELECT id, title, (SELECT file FROM temp.protocol_file), protocol_text,
  protocol_sha256, created_utc FROM original.study;
INSERT INTO surface SELECT file, sha256, size, zstd
  FROM original.surface;
INSERT INTO participant SELECT pseudonym, mode, participant_index, order_index,
  pseudonym.group_name, pseudonym.group_assignment
  FROM original.participant JOIN temp.pseudonym USING (participant_id)
  ORDER BY participant.rowid;
INSERT INTO session SELECT session_id, pseudonym, planned.planned_session, planned.protocol_text, seed, planned_order, language, resumes, rate_hz,
  rig_text, device, scheduler, doctor, program_version, git_hash, compiler, started_utc
  FROM original.session JOIN temp.pseudonym USING (participant_id)
  JOIN temp.planned AS planned USING (session_id) ORDER BY session_id;
INSERT INTO trial SELECT trial_id, session_id, number, attempt, block, task, is_practice, is_catch,
  presented, repetition, status, duration_s
  FROM original.trial ORDER BY trial_id;
INSERT INTO alternative SELECT trial_id, position, label, stimulus, is_comparison
  FROM original.alternative ORDER BY trial_id, position;
INSERT INTO axis_value SELECT trial_id, position, axis, value
  FROM original.axis_value ORDER BY rowid;
INSERT INTO response SELECT response_id, trial_id, response, is_correct, response_time_s,
  time_from_first_contact_s, confidence, supersedes, given_by
  FROM original.response ORDER BY response_id;
INSERT INTO event SELECT trial_id, t_s, kind, value
  FROM original.event ORDER BY rowid;
INSERT INTO session_event SELECT session_id, t_s, state, number,
  CASE WHEN detail = '' OR state IN ('instructions', 'form', 'answering', 'practised', 'faulted',
    'repeated', 'skipped', 'timed_out', 'paused') THEN detail ELSE '(removed)' END
  FROM original.session_event ORDER BY rowid;
INSERT INTO form_answer SELECT session_id, t_s, form, asked, item,
  CASE WHEN answer IS NULL OR (form, item) IN (SELECT form, item FROM temp.kept) THEN answer
    ELSE '(removed)' END
  FROM original.form_answer ORDER BY rowid;
INSERT INTO operator_action SELECT action_id, session_id, t_s, action, number,
  CASE WHEN detail = '' THEN ''
    WHEN action <> 'amend' THEN '(removed)'
    WHEN (detail ->> '$.form', detail ->> '$.item') IN (SELECT form, item FROM temp.kept)
      THEN detail
    WHEN detail ->> '$.before' IS NULL THEN json_set(detail, '$.after', '(removed)')
    ELSE json_set(detail, '$.before', '(removed)', '$.after', '(removed)') END
  FROM original.operator_action ORDER BY action_id;
INSERT INTO trace_chunk SELECT trial_id, first_tick, ticks, codec, bytes
  FROM original.trace_chunk ORDER BY trial_id, first_tick;
INSERT INTO tick_statistics SELECT trial_id, ticks, late, skipped, saturated, dropped_samples,
  lateness_p999_s, worst_lateness_s, fault
  FROM original.tick_statistics ORDER BY trial_id;
)sql";
constexpr const char* copy_actuators_sql = R"sql(
INSERT INTO actuator SELECT trial_id, rate_hz, delay_s, full_scale_n, last_n, mean_square_n2,
  ticks_lost, dropped_periods FROM original.actuator ORDER BY trial_id;
INSERT INTO actuator_chunk SELECT trial_id, first_period, periods, samples, codec, bytes
  FROM original.actuator_chunk ORDER BY trial_id, first_period;
)sql";

void fill_database(Database& database, const std::string& original, const StudyRow& study,
                   const Redaction& redaction) {
  database.run("PRAGMA temp_store = MEMORY");
  Statement{database, "ATTACH ? AS original"}.bind(original).finish();
  const std::int64_t version = database.pragma("original.user_version");
  const bool has_groups = version >= first_version_with_groups;
  const bool has_planned_sessions = version >= first_version_with_planned_sessions;
  Transaction all{database};
  database.run(schema_sql);
  database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id,
                           schema_version));
  Statement{database,
            "CREATE TEMP TABLE pseudonym AS SELECT participant_id, printf('%s-%03d', ?, "
            "row_number() OVER (ORDER BY min(session_id))) AS pseudonym, "s +
                (has_groups ? "group_name, group_assignment "
                            : "NULL AS group_name, NULL AS group_assignment ") +
                "FROM original.participant LEFT JOIN original.session USING (participant_id) "
                "GROUP BY participant_id"}
      .bind(redaction.prefix)
      .finish();
  database.run(
      "CREATE TEMP TABLE planned AS SELECT session_id, "s +
      (has_planned_sessions ? "planned_session, protocol_text "
                            : "NULL AS planned_session, NULL AS protocol_text ") +
      "FROM original.session; "
      "CREATE TEMP TABLE kept (form TEXT, item TEXT); CREATE TEMP TABLE protocol_file (file TEXT)");
  Statement{database, "INSERT INTO temp.protocol_file VALUES (?)"}
      .bind(fs::path{study.protocol_file}.filename().string())
      .finish();
  for (const auto& [form, item] : redaction.kept_items) {
    Statement{database, "INSERT INTO temp.kept VALUES (?, ?)"}.bind(form).bind(item).finish();
  }
  database.run(copy_sql);
  if (version >= first_version_with_actuators) {
    database.run(copy_actuators_sql);
  }
  all.commit();
}
}  // namespace

void write_redacted_copy(const std::string& directory, const std::string& copy,
                         const Redaction& redaction) {
  const StudyRow study = Store::open_existing(directory).study();
  {
    Database database{(fs::path{copy} / "study.db").string(), Database::Access::write};
    fill_database(database, fs::absolute(fs::path{directory} / "study.db").string(), study,
                  redaction);
  }
  StudyRow copied = study;
  copied.protocol_file = fs::path{study.protocol_file}.filename().string();
  Store::open_or_create(copy, copied);  // which writes the journal that is missing
}
}  // namespace tapstudy::results
