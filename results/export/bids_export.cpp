#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "results/export/bids_files.hpp"
#include "results/export/csv_file.hpp"
#include "results/export/gzip_file.hpp"
#include "results/export/study_export.hpp"
#include "results/export/table.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;

// Columns of a _beh.tsv: of BIDS the first, of the data dictionary the second name.
struct Renamed {
  const char* name;
  const char* known_as;
};
constexpr std::array renamed{Renamed{"trial", "number"}, Renamed{"trial_type", "stimulus"},
                             Renamed{"response", "response"},
                             Renamed{"response_time", "response_time_s"}};
constexpr const char* further_columns =
    "alternatives is_correct is_corrected first_response given_by confidence "
    "time_from_first_contact_s trial_id "
    "attempt repetition is_practice is_catch presented status duration_s first_contact_s contacts "
    "impacts late_impacts max_impact_speed_m_s ticks late_ticks skipped_ticks saturated_ticks "
    "dropped_samples";

// v_trials with a column `alternatives`.
constexpr const char* trials_with_alternatives = R"sql((
SELECT v_trials.*, (
  SELECT group_concat(stimulus || iif(is_comparison, '*', '') || coalesce((
      SELECT ' (' || group_concat(axis || '=' || printf('%.9g', value), ', ') || ')'
      FROM axis_value WHERE axis_value.trial_id = one.trial_id
        AND axis_value.position = one.position), ''), '; ')
  FROM (SELECT * FROM alternative WHERE alternative.trial_id = v_trials.trial_id
        ORDER BY position) AS one) AS alternatives
FROM v_trials))sql";

struct Labels {
  BidsLabels participants;
  BidsLabels tasks;
  std::map<std::int64_t, std::string> sessions;  // by id: "_ses-01", or empty
};

std::vector<Column> behaviour_columns() {
  std::vector<Column> columns;
  for (const Renamed& one : renamed) {
    columns.push_back(known_column(one.known_as));
  }
  std::ranges::copy(known_columns(further_columns), std::back_inserter(columns));
  return columns;
}

// Reads some columns of a view, each row as told.
void each_row(Store& store, const std::vector<Column>& columns, const std::string& from,
              const std::function<void(Statement&, const Row&)>& show) {
  std::vector<std::string> names;
  std::ranges::transform(columns, std::back_inserter(names), &Column::name);
  store.each_row(fmt::format("SELECT {} FROM {}", fmt::join(names, ", "), from),
                 [&](Statement& statement) { show(statement, row_from(statement, columns)); });
}

std::vector<std::string> texts(Store& store, const std::string& select) {
  std::vector<std::string> found;
  store.each_row(select, [&](Statement& row) { found.push_back(row.text(0)); });
  return found;
}

// Sessions are named only if somebody had several: as the protocol calls them, with an x and a
// number where one was gone on with, or else by their numbers.
std::map<std::int64_t, std::string> session_labels(Store& store) {
  const std::vector<SessionRow> sessions = store.sessions();
  std::vector<std::string> planned;
  for (const SessionRow& session : sessions) {
    if (session.planned_session &&
        std::ranges::find(planned, *session.planned_session) == planned.end()) {
      planned.push_back(*session.planned_session);
    }
  }
  const BidsLabels names = bids_labels(planned, "s");
  std::map<std::int64_t, std::string> labels;
  std::map<std::pair<std::string, std::string>, int> count;
  bool is_needed = !planned.empty();
  for (const SessionRow& session : sessions) {
    const std::string name = session.planned_session.value_or("");
    const int number = ++count[{session.participant_id, name}];
    is_needed = is_needed || number > 1;
    labels[session.id] = name.empty() ? fmt::format("ses-{:02}", number)
                         : number > 1 ? fmt::format("ses-{}x{}", names.by_name.at(name), number)
                                      : fmt::format("ses-{}", names.by_name.at(name));
  }
  if (!is_needed) {
    std::ranges::for_each(labels, [](auto& label) { label.second.clear(); });
  }
  return labels;
}

class Dataset {
 public:
  Dataset(fs::path root, Store& store, const StudyExport& study)
      : root_{std::move(root)},
        store_{&store},
        study_{&study},
        labels_{
            bids_labels(texts(store, "SELECT participant_id FROM participant ORDER BY rowid"), "p"),
            bids_labels(texts(store, "SELECT DISTINCT block FROM trial ORDER BY trial_id"), "task"),
            session_labels(store)} {}

  void write() {
    core::write_new_file(root_ / "dataset_description.json",
                         dataset_description(study_->provenance));
    write_participants();
    write_phenotypes();
    write_behaviour();
    write_events();
    write_tasks();
    each_traced_trial(*study_, [&](std::int64_t trial) { write_recording(trial); });
    core::write_new_file(root_ / "README", readme());
  }

 private:
  struct Place {
    fs::path directory;
    std::string prefix;  // sub-01_ses-01_task-main
  };
  Place place(const std::string& participant, std::int64_t session, const std::string& block) {
    const std::string subject = "sub-" + labels_.participants.by_name.at(participant);
    const std::string& label = labels_.sessions.at(session);
    const fs::path directory =
        label.empty() ? root_ / subject / "beh" : root_ / subject / label / "beh";
    return {directory, fmt::format("{}_{}task-{}", subject, label.empty() ? label : label + "_",
                                   labels_.tasks.by_name.at(block))};
  }

  void write_participants() {
    std::string lines;
    const bool has_groups = store_->has_groups();
    const std::vector<Column> own =
        known_columns(has_groups ? "participant_id mode is_excluded group_name"
                                 : "participant_id mode is_excluded");
    const std::vector<ParticipantsColumn> asked = participants_columns(*store_, study_->forms);
    each_row(*store_, own, "v_sessions GROUP BY participant_id ORDER BY min(session_id)",
             [&](Statement& statement, Row row) {
               const std::string participant = statement.text(0);
               row.front() = "sub-" + labels_.participants.by_name.at(participant);
               for (const ParticipantsColumn& column : asked) {
                 const auto answer = column.answers.find(participant);
                 row.push_back(answer == column.answers.end() ? Cell{} : Cell{answer->second});
               }
               lines += tsv_line(row);
             });
    std::vector<DescribedColumn> described;
    Row header;
    for (Column column : own) {
      column.name = column.name == "group_name" ? "group" : column.name;  // as BIDS has it
      header.emplace_back(column.name);
      described.push_back({column});
    }
    for (const ParticipantsColumn& column : asked) {
      header.emplace_back(column.column.column.name);
      described.push_back(column.column);
    }
    core::write_new_file(root_ / "participants.tsv", tsv_line(header) + lines);
    core::write_new_file(root_ / "participants.json", table_sidecar(described));
  }

  void write_phenotypes() {
    for (const Phenotype& tool : phenotypes(*store_, study_->forms, labels_.participants.by_name)) {
      core::make_directories((root_ / "phenotype").string());
      core::write_new_file(root_ / "phenotype" / (tool.name + ".tsv"), tool.table);
      core::write_new_file(root_ / "phenotype" / (tool.name + ".json"), tool.sidecar);
    }
  }

  void write_events() {
    for (const BlockEvents& events : events_of_blocks(*store_)) {
      const Place where = place(events.participant, events.session, events.block);
      core::write_new_file(where.directory / (where.prefix + "_events.tsv"), events.table);
    }
  }

  static std::string header() {
    Row names;
    for (const Renamed& one : renamed) {
      names.emplace_back(std::string{one.name});
    }
    for (const Column& column : known_columns(further_columns)) {
      names.emplace_back(column.name);
    }
    names.emplace_back(std::string{"recording"});
    return tsv_line(names);
  }

  void write_behaviour() {
    std::vector<Column> columns = behaviour_columns();
    const std::size_t shown = columns.size();
    std::ranges::copy(known_columns("participant_id session_id block trial_id number attempt"),
                      std::back_inserter(columns));
    std::map<fs::path, std::string> files;
    const std::string source = fmt::format("{} ORDER BY trial_id", trials_with_alternatives);
    each_row(*store_, columns, source, [&](Statement& statement, Row row) {
      const auto at = static_cast<int>(shown);
      const Place where =
          place(statement.text(at), statement.integer(at + 1), statement.text(at + 2));
      row.resize(shown);
      row.emplace_back();  // missing of a trial without a trace
      if (std::ranges::binary_search(study_->trials, statement.integer(at + 3))) {
        row.back() = recording(statement.integer(at + 4), statement.integer(at + 5));
      }
      std::string& text = files[where.directory / (where.prefix + "_beh.tsv")];
      text += (text.empty() ? header() : "") + tsv_line(row);
    });
    for (const auto& [file, text] : files) {
      core::make_directories(file.parent_path().string());
      core::write_new_file(file, text);
    }
  }

  // Of a trial presented for the third time "trial007x3".
  static std::string recording(std::int64_t number, std::int64_t attempt) {
    return fmt::format("trial{:03}", number) + (attempt > 1 ? fmt::format("x{}", attempt) : "");
  }

  void write_tasks() {
    for (const auto& [block, label] : labels_.tasks.by_name) {
      const auto text = std::ranges::find(study_->blocks, block, &BlockText::name);
      const BlockText known = text == study_->blocks.end() ? BlockText{.name = block} : *text;
      core::write_new_file(root_ / fmt::format("task-{}_beh.json", label),
                           task_sidecar(label, known, described_behaviour(known)));
      core::write_new_file(root_ / fmt::format("task-{}_events.json", label),
                           table_sidecar(event_columns()));
    }
  }

  static std::vector<DescribedColumn> described_behaviour(const BlockText& block) {
    std::vector<DescribedColumn> described;
    for (const Column& column : behaviour_columns()) {
      described.push_back({column});
      const auto found = std::ranges::find(renamed, column.name, &Renamed::known_as);
      if (found != renamed.end()) {
        described.back().column.name = found->name;
      }
      if (described.back().column.name == "trial_type") {
        described.back().levels = block.stimuli;
      } else if (described.back().column.name == "response") {
        described.back().levels = block.responses;
      }
    }
    described.push_back({{"recording", CellType::text, "",
                          "Label of the recording (_physio.tsv.gz) of the trial"}});
    return described;
  }

  void write_recording(std::int64_t trial) {
    Place where;
    double rate_hz{};
    std::string label;
    store_->each_row(
        fmt::format("SELECT participant_id, session_id, block, rate_hz, number, attempt FROM "
                    "trial_context JOIN "
                    "v_sessions USING (session_id, participant_id) WHERE trial_id = {}",
                    trial),
        [&](Statement& row) {
          where = place(row.text(0), row.integer(1), row.text(2));
          rate_hz = row.real(3);
          label = recording(row.integer(4), row.integer(5));
        });
    const std::string name = where.prefix + "_recording-" + label + "_physio";
    GzipFile file{(where.directory / (name + ".tsv.gz")).string()};
    trace_table(*store_, trial).each_row([&](const Row& row) { file.add(tsv_line(row)); });
    file.close();
    core::write_new_file(where.directory / (name + ".json"),
                         recording_sidecar(rate_hz, trace_columns()));
  }

  std::string readme() const {
    std::string text = fmt::format(
        "{}\n\n"
        "A study of tapped plates, written by {}. Participants may be real, pilots or simulated:\n"
        "participants.tsv says which, and who was excluded from the analysis.\n\n"
        "Each _beh.tsv has a row each time that a trial was presented, practice and catch trials\n"
        "included. Each _physio.tsv.gz holds every tick of the haptic loop in one trial: the "
        "column\n"
        "recording of _beh.tsv names it. Its time zero is the trial's first tick; t_ns is the "
        "time\n"
        "measured, also where ticks were skipped. Each _events.tsv has the changes of the\n"
        "session's state, with times from its begin. phenotype/ has the questionnaires.\n"
        "Operators' notes, reasons of exclusion and answers in free text are left out.\n",
        study_->provenance.title, study_->provenance.program);
    for (const std::string& note : labels_.participants.notes) {
      text += "Participants: " + note + ".\n";
    }
    for (const std::string& note : labels_.tasks.notes) {
      text += "Tasks: " + note + ".\n";
    }
    return text;
  }

  fs::path root_;
  Store* store_;
  const StudyExport* study_;
  Labels labels_;
};
}  // namespace

void write_bids_dataset(const std::string& directory, Store& store, const StudyExport& study) {
  Dataset{directory, store, study}.write();
}
}  // namespace tapstudy::results
