#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <utility>

#include "analysis/report/writers.hpp"
#include "analysis/statistics/counts_csv.hpp"
#include "core/error.hpp"
#include "core/output_file.hpp"
#include "protocols/tasks/shipped_tasks.hpp"
#include "results/store.hpp"
#include "runner/commands/commands.hpp"
#include "runner/experiments/study_summary.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
using analysis::Summary;
using results::Mode;

struct ReportOptions {
  std::vector<std::string> directories;
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

Summary summary_of_directories(const ReportOptions& options) {
  std::vector<results::Store> stores;
  std::vector<results::SessionRow> sessions;
  for (const std::string& directory : options.directories) {
    stores.push_back(store_to_report(directory));
    const auto more = stores.back().sessions();
    sessions.insert(sessions.end(), more.begin(), more.end());
  }
  std::vector<StudyStore> studies;
  for (std::size_t i = 0; i < stores.size(); ++i) {
    studies.push_back({options.directories[i], &stores[i]});
  }
  return summary_of_study(studies, mode_to_report(options, sessions));
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
  for (const analysis::CsvTable& table : analysis::csv_of(summary.sections)) {
    add(table.name, table_text(summary, table));
  }
  core::write_all_or_none(files, options.replace ? core::Existing::replaced : core::Existing::kept);
  for (const core::NewFile& file : files) {
    fmt::print("{}\n", file.name);
  }
}

void run_report(ReportOptions options) {
  if (options.directories.empty() == options.counts.empty()) {
    throw core::InvalidInput{"report takes either directories of a study or --counts FILE.csv"};
  }
  if (options.directories.size() > 1 && options.out.empty()) {
    throw core::InvalidInput{"--out: a report of several directories needs one of its own"};
  }
  const Summary summary = options.counts.empty()
                              ? summary_of_directories(options)
                              : summary_of_counts(options.counts, options.responses);
  analysis::write_text(std::cout, summary);
  std::cout << std::endl;
  if (options.out.empty() && options.counts.empty()) {
    options.out = options.directories.front();
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
  command.arguments("directories", options->directories,
                    "Directory of a study; several, if it was run on several machines");
  command.option("--counts", options->counts,
                 "Instead of a study: a matrix or a stimulus,response table (CSV)");
  command.option("--responses", options->responses,
                 "With --counts: answers that are no stimuli, comma-separated");
  command.option("--out", options->out, "Output directory; default: the study's own");
  command.one_of("--mode", options->mode, {"real", "pilot", "simulated"},
                 "Which sessions: real, pilot or simulated");
  command.flag("--replace", options->replace, "Replace an earlier report");
  command.on_run([options] { run_report(*options); });
}
}  // namespace tapstudy::runner
