#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <utility>

#include "analysis/report/writers.hpp"
#include "analysis/statistics/counts_csv.hpp"
#include "core/error.hpp"
#include "core/output_file.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/tasks/shipped_tasks.hpp"
#include "results/store.hpp"
#include "runner/commands/commands.hpp"
#include "runner/experiments/study_design.hpp"
#include "runner/session/given_up_trials.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
using analysis::Summary;
using results::Mode;

struct ReportOptions {
  std::string directory;
  std::string counts;
  std::string out;
  std::string mode;
  std::string responses;
  bool replace{false};
};

// Real sessions by default; if there are none, the available ones, which the report states.
Mode mode_to_report(const ReportOptions& options,
                    const std::vector<results::SessionRow>& sessions) {
  if (!options.mode.empty()) {
    return results::mode_from(options.mode);
  }
  for (const Mode mode : {Mode::real, Mode::pilot}) {
    if (std::ranges::find(sessions, mode, &results::SessionRow::mode) != sessions.end()) {
      return mode;
    }
  }
  return Mode::simulated;
}

std::vector<std::pair<std::string, std::string>> provenance(
    const results::StudyRow& study, const std::vector<results::SessionRow>& sessions, Mode mode) {
  std::set<std::string> programs;
  std::set<std::string> devices;
  std::vector<std::string> seeds;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode) {
      programs.insert(
          fmt::format("{} ({}, {})", session.program_version, session.git_hash, session.compiler));
      devices.insert(
          fmt::format("{}, {} Hz, {}", session.device, session.rate_hz, session.scheduler));
      seeds.push_back(fmt::format("{} {}", session.participant_id, session.seed));
    }
  }
  return {{"protocol", study.protocol_file},
          {"protocol SHA-256", study.protocol_sha256},
          {"tapstudy", fmt::format("{}", fmt::join(programs, "; "))},
          {"device", fmt::format("{}", fmt::join(devices, "; "))},
          {"seeds", fmt::format("{}", fmt::join(seeds, ", "))}};
}

// The sessions that ended early: "P03: 5 of 8 trials".
std::vector<std::string> unfinished(results::Store& store, const protocols::Protocol& protocol,
                                    const std::vector<results::SessionRow>& sessions, Mode mode) {
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::map<std::string, std::ptrdiff_t> planned;
  for (const results::SessionRow& session : sessions) {
    if (session.mode == mode && !excluded.contains(session.participant_id)) {
      planned[session.participant_id] = std::ranges::count(session.planned_order, '\n');
    }
  }
  std::vector<std::string> found;
  for (const auto& [participant, trials] : planned) {
    const auto done = std::ssize(store.answered_trials(participant)) +
                      std::ssize(given_up_trials(protocol, participant, store));
    if (done < trials) {
      found.push_back(fmt::format("{}: {} of {} trials", participant, done, trials));
    }
  }
  return found;
}

using Excluded = std::map<std::string, std::string>;  // by id: why
std::vector<std::string> excluded_of(const Excluded& excluded,
                                     const std::vector<results::SessionRow>& sessions, Mode mode) {
  std::vector<std::string> found;
  for (const auto& [participant, reason] : excluded) {
    const auto session =
        std::ranges::find(sessions, participant, &results::SessionRow::participant_id);
    if (session != sessions.end() && session->mode == mode) {
      found.push_back(fmt::format("{}: {}", participant, reason));
    }
  }
  return found;
}

// "P03: 2 answers corrected by the operator (1 of them from wrong to right), 1 trial skipped".
std::vector<std::string> deviations_of(results::Store& store, const Excluded& excluded, Mode mode) {
  std::vector<std::string> found;
  for (const results::DeviationRow& row : store.deviations()) {
    if (row.mode != mode || excluded.contains(row.participant_id)) {
      continue;
    }
    std::vector<std::string> parts;
    if (row.corrected > 0) {
      parts.push_back(
          fmt::format("answers corrected by the operator: {} ({} of them from wrong to right)",
                      row.corrected, row.corrected_to_right));
    }
    if (row.skipped > 0) {
      parts.push_back(fmt::format("trials skipped: {}", row.skipped));
    }
    if (row.timed_out > 0) {
      parts.push_back(fmt::format("presentations that timed out: {}", row.timed_out));
    }
    found.push_back(fmt::format("{}: {}", row.participant_id, fmt::join(parts, ", ")));
  }
  return found;
}

// From the store alone: the files named by the protocol may no longer exist.
protocols::Protocol stored_protocol(const results::StudyRow& study) {
  return protocols::parse_protocol(
      study.protocol_text, study.protocol_file, [&](const std::string& file) {
        const auto found = std::ranges::find(study.surfaces, file, &results::SurfaceRow::file);
        if (found == study.surfaces.end()) {
          throw core::InvalidInput{file + ": is not stored with the study"};
        }
        return found->bytes;
      });
}

// The journal alone is left where the database was lost.
results::Store store_to_report(const std::string& directory) {
  if (results::Store::has_database(directory) || !results::Store::has_journal(directory)) {
    return results::Store::open_existing(directory);
  }
  warn(directory +
       ": study.db is missing; this report is made from answers.journal alone, without what the "
       "participants did (impacts, visits, late ticks)");
  return results::Store::from_journal(directory);
}

Summary summary_of_study(const ReportOptions& options) {
  results::Store store = store_to_report(options.directory);
  const results::StudyRow study = store.study();
  const std::vector<results::SessionRow> sessions = store.sessions();
  const Mode mode = mode_to_report(options, sessions);
  const std::map<std::string, std::string> excluded = store.excluded_participants();
  std::vector<results::AnswerRow> answers = store.answers();
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.mode != mode || answer.is_practice || excluded.contains(answer.participant_id);
  });
  if (answers.empty()) {
    throw core::InvalidInput{fmt::format("{}: no answers of {} participants to report",
                                         options.directory, results::to_text(mode))};
  }
  const protocols::Protocol protocol = stored_protocol(study);
  std::vector<results::VisitRow> visits = store.visits();
  std::erase_if(visits, [&](const results::VisitRow& visit) {
    return std::ranges::find(answers, visit.participant_id, &results::AnswerRow::participant_id) ==
           answers.end();
  });
  Summary summary = analysis::summarise(design_of(protocol, mode), answers, visits);
  summary.provenance = provenance(study, sessions, mode);
  summary.unfinished = unfinished(store, protocol, sessions, mode);
  summary.excluded = excluded_of(excluded, sessions, mode);
  summary.deviations = deviations_of(store, excluded, mode);
  return summary;
}

std::vector<std::string> listed(const std::string& words) {
  std::vector<std::string> all;
  std::istringstream stream{words};
  for (std::string word; std::getline(stream, word, ',');) {
    all.push_back(word);
  }
  return all;
}

Summary summary_of_counts(const std::string& file, const std::string& responses) {
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  const analysis::CountsTable counts = analysis::read_counts(text, file, listed(responses));
  Summary summary = analysis::summarise(counts.matrix, fs::path{file}.stem().string(),
                                        protocols::identification().name(), counts.mode);
  summary.provenance = {{"counts", file}};
  return summary;
}

// A table that leaves its report still says whose answers it holds.
std::string table_text(const Summary& summary, const analysis::CsvTable& table) {
  std::ostringstream text;
  if (!banner(summary).empty()) {
    text << analysis::mode_mark << summary.modes << '\n';
  }
  table.write(text);
  return text.str();
}

void write_files(const ReportOptions& options, const Summary& summary) {
  std::error_code error;
  fs::create_directories(options.out, error);
  if (!fs::is_directory(options.out, error)) {
    throw core::InvalidInput{options.out + ": cannot be made a directory"};
  }
  std::vector<core::NewFile> files;
  const auto add = [&](const std::string& name, std::string text) {
    files.push_back({(fs::path{options.out} / name).string(), std::move(text)});
  };
  const auto written = [&](void (*write)(std::ostream&, const Summary&)) {
    std::ostringstream text;
    write(text, summary);
    return text.str();
  };
  add("report.html", written(analysis::write_html));
  add("report.json", written(analysis::write_json));
  for (const auto& block : summary.blocks) {
    for (const analysis::CsvTable& table : block->tables()) {
      add(block->block.empty() ? table.name : block->block + "_" + table.name,
          table_text(summary, table));
    }
  }
  core::write_all_or_none(files, options.replace ? core::Existing::replaced : core::Existing::kept);
  for (const core::NewFile& file : files) {
    fmt::print("{}\n", file.name);
  }
}

void run_report(ReportOptions options) {
  if (options.directory.empty() == options.counts.empty()) {
    throw core::InvalidInput{"report takes either the directory of a study or --counts FILE.csv"};
  }
  const Summary summary = options.counts.empty()
                              ? summary_of_study(options)
                              : summary_of_counts(options.counts, options.responses);
  analysis::write_text(std::cout, summary);
  std::cout << std::endl;
  if (options.out.empty() && options.counts.empty()) {
    options.out = options.directory;
  }
  if (!options.out.empty()) {
    write_files(options, summary);
  }
}
}  // namespace

void add_report(CommandParser& line) {
  Command command =
      line.add("report", "Confusion matrix and statistics: terminal, HTML, JSON and CSV");
  const auto options = std::make_shared<ReportOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::optional);
  command.option("--counts", options->counts,
                 "Instead of a study: a matrix or a stimulus,response table (CSV)");
  command.option("--responses", options->responses,
                 "With --counts: answers that are no stimuli, comma-separated");
  command.option("--out", options->out, "Output directory; default: the study's directory");
  command.one_of("--mode", options->mode, {"real", "pilot", "simulated"},
                 "Which sessions: real, pilot or simulated");
  command.flag("--replace", options->replace, "Replace an earlier report");
  command.on_run([options] { run_report(*options); });
}
}  // namespace tapstudy::runner
