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

Summary summary_of_directory(const ReportOptions& options) {
  results::Store store = store_to_report(options.directory);
  return summary_of_study(store, mode_to_report(options, store.sessions()), options.directory);
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
                              ? summary_of_directory(options)
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
