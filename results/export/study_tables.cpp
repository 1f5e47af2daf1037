#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "results/export/study_export.hpp"
#include "results/export/table.hpp"
#include "results/store/form_amendments.hpp"
namespace tapstudy::results {
namespace {
struct Source {
  const char* name;
  const char* description;
  const char* columns;  // of the data dictionary
  const char* relation;
  const char* rest;  // of the query: what is joined, and the order
};

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): joined to literals
#define WHO \
  "session_id participant_id group_name planned_session mode is_excluded exclusion_reason "
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define WHICH_TRIAL \
  "trial_id " WHO "block task number attempt is_practice is_catch presented status "

constexpr std::array sources{
    Source{"sessions", "One row per session.",
           WHO "group_assignment participant_index order_index resumes started_utc language "
               "rate_hz device "
               "scheduler program_version git_hash compiler seed planned_order rig_text "
               "protocol_text doctor",
           "v_sessions", "ORDER BY session_id"},
    Source{"trials", "One row per presentation of a trial.",
           WHICH_TRIAL
           "repetition stimulus response is_correct is_corrected first_response first_is_correct "
           "given_by confidence response_time_s time_from_first_contact_s duration_s "
           "first_contact_s contacts impacts late_impacts max_impact_speed_m_s ticks late_ticks "
           "skipped_ticks saturated_ticks dropped_samples lateness_p999_s worst_lateness_s fault",
           "v_trials", "ORDER BY trial_id"},
    Source{"answers", "One row per answer as given, and one per correction.",
           "response_id " WHICH_TRIAL
           "stimulus response is_correct response_time_s time_from_first_contact_s confidence "
           "given_by is_correction supersedes is_current",
           "v_answers", "ORDER BY response_id"},
    Source{
        "visits",
        "One row each time that an alternative was switched to, until the next switch or the end "
        "of the trial.",
        WHICH_TRIAL "visit position label stimulus begin_s end_s dwell_s", "v_visits",
        "ORDER BY trial_id, visit"},
    Source{"events", "One row per event of a trial.", WHICH_TRIAL "t_s kind value", "event",
           "JOIN trial_context USING (trial_id) ORDER BY trial_id, t_s, event.rowid"},
    Source{"session_events", "One row per change of a session's state.",
           WHO "t_s state number detail", "session_event",
           "JOIN v_sessions USING (session_id) "
           "ORDER BY session_id, t_s, session_event.rowid"},
    Source{"questionnaires", "One row per item of a questionnaire.",
           WHO "t_s form asked item answer amended amended_from", current_form_answer,
           "JOIN v_sessions USING (session_id) ORDER BY session_id, t_s, form_answer.rowid"},
    Source{"operator_actions",
           "One row per action of the operator, and per correction by the participant (answers: "
           "given_by).",
           "action_id " WHO "t_s action number detail", "operator_action",
           "JOIN v_sessions USING (session_id) ORDER BY action_id"},
};

constexpr const char* alternative_columns =
    WHICH_TRIAL "position label stimulus is_comparison visits total_dwell_s";
constexpr const char* alternatives_order = "ORDER BY trial_id, position";
#undef WHICH_TRIAL
#undef WHO

Cell cell_of(Statement& row, int column, CellType type) {
  if (row.is_null(column)) {
    return std::monostate{};
  }
  switch (type) {
    case CellType::boolean:
    case CellType::integer:
      return row.integer(column);
    case CellType::real:
      return row.real(column);
    case CellType::text:
      return row.text(column);
  }
  return std::monostate{};
}

Table table_from(Store& store, const Source& source, std::vector<Column> columns,
                 const std::vector<std::string>& expressions) {
  const std::string select = fmt::format("SELECT {} FROM {} {}", fmt::join(expressions, ", "),
                                         source.relation, source.rest);
  return {source.name, source.description, columns, [&store, select, columns](const RowSink& sink) {
            store.each_row(select,
                           [&](Statement& statement) { sink(row_from(statement, columns)); });
          }};
}

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) {
    names.push_back(column.name);
  }
  return names;
}

std::string quoted(const std::string& text) {
  std::string literal{"'"};
  for (const char c : text) {
    literal += c == '\'' ? "''" : std::string{c};
  }
  return literal + "'";
}

// Without those of groups where nobody is in one; likewise of planned sessions, changed texts and
// corrected answers to questionnaires.
std::vector<Column> columns_of(Store& store, const char* names) {
  std::vector<Column> columns = known_columns(names);
  const auto leave_out = [&](bool is_used, std::string_view begin) {
    if (!is_used) {
      std::erase_if(columns, [&](const Column& column) { return column.name.starts_with(begin); });
    }
  };
  leave_out(store.has_groups(), "group_");
  leave_out(store.has_planned_sessions(), "planned_session");
  leave_out(store.has_changed_texts(), "protocol_text");
  leave_out(!form_amendments(store).empty(), "amended");
  return columns;
}

Table alternatives_table(Store& store, const std::map<std::string, std::string>& axis_units) {
  std::vector<Column> columns = columns_of(store, alternative_columns);
  std::vector<std::string> expressions = names_of(columns);
  store.each_row("SELECT DISTINCT axis FROM axis_value ORDER BY axis", [&](Statement& row) {
    const std::string axis = row.text(0);
    const auto unit = axis_units.find(axis);
    columns.push_back({axis, CellType::real, unit == axis_units.end() ? "" : unit->second,
                       "Value as presented on the axis " + axis + "; missing if it did not vary"});
    expressions.push_back(
        fmt::format("(SELECT value FROM axis_value WHERE axis_value.trial_id = v_stimuli.trial_id "
                    "AND axis_value.position = v_stimuli.position AND axis = {})",
                    quoted(axis)));
  });
  const Source source{"alternatives", "A row for each of the stimuli presented in a trial.",
                      alternative_columns, "v_stimuli", alternatives_order};
  return table_from(store, source, columns, expressions);
}

Row row_of(const core::TraceSample& s) {
  const auto integer = [](auto value) { return static_cast<std::int64_t>(value); };
  return {s.t_ns,
          s.position_m[0],
          s.position_m[1],
          s.position_m[2],
          s.velocity_m_s[0],
          s.velocity_m_s[1],
          s.velocity_m_s[2],
          s.penetration_m,
          s.penalty_n,
          s.vibration_n,
          s.sinusoid_n,
          s.force_n[0],
          s.force_n[1],
          s.force_n[2],
          s.achieved_n[0],
          s.achieved_n[1],
          s.achieved_n[2],
          s.pose_residual_m,
          s.closure_margin,
          s.motor_voltage_v,
          integer(s.alternative),
          integer(s.touching),
          integer(s.impact),
          integer(s.saturated),
          integer(s.fault),
          integer(s.missed_replies),
          integer(s.late)};
}
}  // namespace

std::vector<Table> study_tables(Store& store,
                                const std::map<std::string, std::string>& axis_units) {
  std::vector<Table> tables;
  for (const Source& source : sources) {
    const std::vector<Column> columns = columns_of(store, source.columns);
    tables.push_back(table_from(store, source, columns, names_of(columns)));
  }
  tables.push_back(alternatives_table(store, axis_units));
  return tables;
}

Row row_from(Statement& statement, const std::vector<Column>& columns) {
  Row row;
  row.reserve(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    row.push_back(cell_of(statement, static_cast<int>(i), columns[i].type));
  }
  return row;
}

void each_traced_trial(const StudyExport& study, const std::function<void(std::int64_t)>& write) {
  for (std::size_t i = 0; i < study.trials.size(); ++i) {
    write(study.trials[i]);
    core::tell_count(study.count, i + 1, study.trials.size());
  }
}

std::vector<std::int64_t> trials_with_traces(Store& store) {
  std::vector<std::int64_t> trials;
  store.each_row("SELECT DISTINCT trial_id FROM trace_chunk ORDER BY trial_id",
                 [&](Statement& row) { trials.push_back(row.integer(0)); });
  return trials;
}

std::vector<Column> trace_columns() {
  return known_columns(
      "t_ns position_x_m position_y_m position_z_m velocity_x_m_s velocity_y_m_s velocity_z_m_s "
      "penetration_m penalty_n vibration_n sinusoid_n force_x_n force_y_n force_z_n achieved_x_n "
      "achieved_y_n achieved_z_n pose_residual_m closure_margin motor_voltage_v alternative "
      "touching impact saturated fault_code missed_replies late");
}

namespace {
Table table_of_trial(Store& store, std::int64_t trial_id, const char* what,
                     std::vector<Column> columns, std::function<void(const RowSink&)> each_row) {
  std::string whose;
  store.each_row(
      fmt::format("SELECT participant_id, mode FROM trial_context WHERE trial_id = {}", trial_id),
      [&](Statement& row) { whose = fmt::format("{} ({})", row.text(0), row.text(1)); });
  return {fmt::format("trial_{:06}", trial_id),
          fmt::format("{} of trial {}, of participant {}.", what, trial_id, whose),
          std::move(columns), std::move(each_row)};
}

void add_samples(const Store::StoredActuator& actuator, const RowSink& sink) {
  std::size_t next = 0;
  for (const core::ActuatorPeriod& period : actuator.trace.periods) {
    for (int i = 0; i < period.samples; ++i) {
      sink({1e-9 * (static_cast<double>(period.heard_at_ns) + i * period.frame_ns),
            actuator.row.full_scale_n * static_cast<double>(actuator.trace.samples[next++]),
            std::int64_t{period.is_heard}});
    }
  }
}

std::optional<Table> actuator_table(Store& store, const std::vector<Column>& columns,
                                    std::int64_t trial_id) {
  const auto actuator = store.actuator(trial_id);
  if (!actuator) {
    return std::nullopt;
  }
  return table_of_trial(store, trial_id, "Every sample of the actuator", columns,
                        [actuator](const RowSink& sink) { add_samples(*actuator, sink); });
}
}  // namespace

Table trace_table(Store& store, std::int64_t trial_id) {
  return table_of_trial(store, trial_id, "Every tick", trace_columns(),
                        [&store, trial_id](const RowSink& sink) {
                          for (const core::TraceSample& sample : store.trace(trial_id)) {
                            sink(row_of(sample));
                          }
                        });
}

std::vector<Recording> recordings(Store& store) {
  std::vector<Recording> all{{"traces", trace_columns(), [&store](std::int64_t trial_id) {
                                return trace_table(store, trial_id);
                              }}};
  if (store.has_actuators()) {
    const std::vector<Column> columns = known_columns("heard_s command_n is_heard");
    all.push_back({"actuator", columns, [&store, columns](std::int64_t trial_id) {
                     return actuator_table(store, columns, trial_id);
                   }});
  }
  return all;
}
}  // namespace tapstudy::results
