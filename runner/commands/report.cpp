#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <utility>

#include "analysis/report/answer_tables/counts_csv.hpp"
#include "analysis/report/comparison.hpp"
#include "analysis/report/figures/image_formats.hpp"
#include "analysis/report/summary.hpp"
#include "analysis/report/writers.hpp"
#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/files/scratch_directory.hpp"
#include "results/server/pull.hpp"
#include "results/store/store.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/studies/counted.hpp"
#include "runner/studies/mixed_models/fit_in_r.hpp"
#include "runner/studies/shares/merge.hpp"
#include "runner/studies/study_summary.hpp"
#include "runner/studies/table_summary.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
namespace fs = std::filesystem;
using analysis::Summary;
using results::Mode;

struct ReportOptions {
  std::vector<std::string> directories;
  std::vector<std::string> counts;
  std::vector<std::string> compared;
  TableOptions table;
  std::string responses;
  std::string order;
  std::string time_unit;
  std::string rows;
  std::string out;
  std::string mode;
  std::string only;
  std::string study;
  bool replace{false};
  bool shows_all{false};
};

Mode mode_of(const ReportOptions& options, const std::vector<results::SessionRow>& sessions) {
  return options.mode.empty() ? mode_to_report(sessions) : results::mode_from(options.mode);
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

Summary summary_of_stores(const ReportOptions& options, const std::vector<std::string>& directories,
                          const std::vector<std::string>& only) {
  std::vector<results::Store> stores;
  std::vector<results::SessionRow> sessions;
  for (const std::string& directory : directories) {
    stores.push_back(store_to_report(directory));
    const auto more = stores.back().sessions();
    sessions.insert(sessions.end(), more.begin(), more.end());
  }
  std::vector<StudyStore> studies;
  for (std::size_t i = 0; i < stores.size(); ++i) {
    studies.push_back({directories[i], &stores[i]});
  }
  return summary_of_study(studies, mode_of(options, sessions), Detail::all, only,
                          fit_mixed_models_in_r);
}

bool is_of_server(const ReportOptions& options) {
  return std::ranges::any_of(options.directories, results::ServerConnection::is_url);
}

// Of all sites of a study on a server.
Summary summary_of_server(const ReportOptions& options, const std::vector<std::string>& only) {
  results::ServerConnection server{options.directories.front()};
  const core::ScratchDirectory scratch;
  std::vector<std::string> directories;
  for (const std::string& name : results::pull_study(server, options.study, scratch.path())) {
    directories.push_back((fs::path{scratch.path()} / name).string());
  }
  return summary_of_stores(options, directories, only);
}

// Shares of one simulation make together what one run would have stored.
Summary summary_of_directories(const ReportOptions& options,
                               const std::vector<std::string>& directories,
                               const std::vector<std::string>& only) {
  if (directories.size() == 1 || !are_shares(directories)) {
    return summary_of_stores(options, directories, only);
  }
  const core::ScratchDirectory whole;
  write_whole(whole_of(directories), whole.path());
  return summary_of_stores(options, {whole.path()}, only);
}

// What an earlier report left in its place, and this one does not write: tables and figures.
std::vector<std::string> left_of_earlier_report(const std::string& folder,
                                                const std::vector<core::NewFile>& files) {
  std::set<std::string> left;
  std::error_code error;
  const auto look_in = [&](const fs::path& in, const std::set<std::string>& kinds) {
    for (fs::directory_iterator at{in, error}, end; !error && at != end; at.increment(error)) {
      if (kinds.contains(at->path().extension().string())) {
        left.insert(at->path().string());
      }
    }
  };
  look_in(folder, {".csv"});
  look_in(fs::path{folder} / "figures", {".svg", ".pdf"});
  for (const core::NewFile& file : files) {
    left.erase(file.name);
  }
  return {left.begin(), left.end()};
}

void warn_of_left_files(const std::string& folder, const std::vector<core::NewFile>& files) {
  constexpr std::size_t most_named = 3;
  const std::vector<std::string> left = left_of_earlier_report(folder, files);
  if (!left.empty()) {
    warn(fmt::format(
        "{}: {} that this report does not have stay there: {}{}", folder,
        counted(left.size(), "file"),
        fmt::join(left.begin(),
                  left.begin() + static_cast<std::ptrdiff_t>(std::min(left.size(), most_named)),
                  ", "),
        left.size() > most_named ? ", …" : ""));
  }
}

void write_files(const ReportOptions& options, const Summary& summary, Progress& progress) {
  const auto figure_files = analysis::figure_files(summary);
  const core::CountHook count = progress.count();
  std::size_t drawn = 0;
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
  add("tables.tex", written(analysis::write_latex));
  for (analysis::TableFile& table : analysis::table_files(summary)) {
    add(table.name, std::move(table.text));
  }
  for (const analysis::FigureFile& figure : figure_files) {
    add("figures/" + figure.name + ".svg", figure.svg);
    add("figures/" + figure.name + ".pdf", analysis::pdf_of_svg(figure.svg));
    core::tell_count(count, ++drawn, figure_files.size());
  }
  core::write_all_or_none(files, options.replace ? core::Existing::replaced : core::Existing::kept);
  warn_of_left_files(options.out, files);
  constexpr std::size_t whole = 3;  // files that hold all of it
  for (std::size_t i = 0; i < whole; ++i) {
    fmt::print("{}\n", files[i].name);
  }
  const std::size_t figures = figure_files.size();
  fmt::print("{} tables as CSV{}\n", files.size() - whole - 2 * figures,
             figures > 0 ? fmt::format(", {} figures as SVG and PDF in {}", figures,
                                       (fs::path{options.out} / "figures").string())
                         : "");
}

// Called before the long computation.
void check_output_is_new(const ReportOptions& options) {
  const std::string page = (fs::path{options.out} / "report.html").string();
  std::error_code error;
  if (!options.out.empty() && !options.replace && fs::exists(page, error)) {
    throw core::InvalidInput{page +
                             ": exists already (--replace replaces it, --out takes another place)"};
  }
}

bool reads_columns(const ReportOptions& options) {
  return options.table.columns.are_given() || !options.table.conditions.empty() ||
         !options.responses.empty() || !options.order.empty() || !options.table.encoding.empty() ||
         options.table.merges_alike || options.table.pools_runs || options.table.pools_tasks ||
         options.table.counts_practice || options.table.are_counts || !options.rows.empty();
}

TableOptions table_options(const ReportOptions& options) {
  TableOptions table = options.table;
  table.responses = analysis::cells_of_option(options.responses, "--responses");
  table.order = analysis::cells_of_option(options.order, "--order");
  if (!options.time_unit.empty()) {
    table.columns.time_unit_s = options.time_unit == "ms" ? 1e-3 : 1.0;
  }
  if (!options.rows.empty()) {
    table.rows =
        options.rows == "stimuli" ? analysis::MatrixRows::stimuli : analysis::MatrixRows::responses;
  }
  return table;
}

// A study's directory, or a table.
Summary summary_of_either(const ReportOptions& options, const std::string& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? summary_of_directories(options, {path}, {})
                                       : summary_of_tables({path}, table_options(options));
}

Summary summary_of_comparison(const ReportOptions& options) {
  if (options.compared.size() != 2) {
    throw core::InvalidInput{"--compare takes two directories of studies, or tables"};
  }
  const Summary first = summary_of_either(options, options.compared.front());
  const Summary second = summary_of_either(options, options.compared.back());
  return analysis::compare({options.compared.front(), &first}, {options.compared.back(), &second});
}

Summary summary_of(const ReportOptions& options) {
  const std::vector<std::string> only = analysis::cells_of_option(options.only, "--only");
  if (is_of_server(options)) {
    return summary_of_server(options, only);
  }
  if (!options.directories.empty()) {
    return summary_of_directories(options, options.directories, only);
  }
  Summary summary = options.compared.empty()
                        ? summary_of_tables(options.counts, table_options(options))
                        : summary_of_comparison(options);
  if (!only.empty()) {
    analysis::keep_only(summary, only);
  }
  return summary;
}

void check_options(const ReportOptions& options) {
  const int sources = static_cast<int>(!options.directories.empty()) +
                      static_cast<int>(!options.counts.empty()) +
                      static_cast<int>(!options.compared.empty());
  if (sources != 1) {
    throw core::InvalidInput{
        "report takes either directories of a study, or --counts FILE.csv, or --compare A B"};
  }
  if (!options.directories.empty() && reads_columns(options)) {
    throw core::InvalidInput{
        "options with columns, --where, --responses, --order, --weights, --encoding, "
        "--merge-alike, --pool-runs, --pool-tasks, --count-practice, --are-counts and --rows say "
        "how to read "
        "--counts FILE.csv"};
  }
  if (is_of_server(options) && (options.directories.size() > 1 || options.out.empty())) {
    throw core::InvalidInput{
        "a report of a server is of all that it has of one study, and needs --out"};
  }
  if (!options.study.empty() && !is_of_server(options)) {
    throw core::InvalidInput{"--study: says which study of a server is meant"};
  }
  if (options.directories.size() > 1 && options.out.empty()) {
    throw core::InvalidInput{"--out: a report of several directories needs one of its own"};
  }
}

void run_report(ReportOptions options) {
  check_options(options);
  if (options.out.empty() && !options.directories.empty()) {
    options.out = (fs::path{options.directories.front()} / report_folder).string();
  }
  check_output_is_new(options);
  Progress progress{"making the report"};
  const Summary summary = summary_of(options);
  constexpr std::size_t most_lines = 15;  // of a table of participants
  constexpr std::size_t screen = 60;      // lines that somebody reads; programs get all
  if (options.shows_all || !is_shown_by_terminal()) {
    analysis::write_text(std::cout, summary, options.shows_all ? analysis::all_lines : most_lines);
  } else {
    analysis::write_text_within(std::cout, summary, screen, most_lines);
  }
  std::cout << std::endl;
  if (!options.out.empty()) {
    write_files(options, summary, progress);
  }
}
// How to read tables of other programs.
void add_table_options(Command& command, const std::shared_ptr<ReportOptions>& options) {
  analysis::AnswerColumns& columns = options->table.columns;
  command.option("--stimulus-column", columns.stimulus, "With --counts: which was presented");
  command.option("--response-column", columns.response, "With --counts: what was answered");
  command.option("--participant-column", columns.participant,
                 "With --counts: by whom; without it, each of several files is one participant's; "
                 "none: not known");
  command.option("--time-column", columns.time, "With --counts: the response time");
  command.one_of("--time-unit", options->time_unit, {"s", "ms"},
                 "Of the response time; default: from the column's name or the file's format");
  command.repeatable("--where", options->table.conditions,
                     "With --counts: COLUMN=VALUE; rows with other values are left out; "
                     "COLUMN!=VALUE: rows with that value");
  command.option("--responses", options->responses,
                 "With --counts: answers that are no stimuli, and GIVEN=STIMULUS for what answers "
                 "stand for, comma-separated");
  command.option(
      "--weights", columns.weight,
      "With --counts: the column that says how many answers a row stands for; none: one");
  command.option(
      "--correct-column", columns.correct,
      "With --counts: whether the file takes the answer for right, which is compared with "
      "the names; none: not compared");
  command.option("--order", options->order,
                 "With --counts: of stimuli and answers, comma-separated; default: as they first "
                 "appear");
  command.option("--encoding", options->table.encoding,
                 "With --counts: of the file, as iconv calls it (UTF-16, windows-1252); default: "
                 "UTF-8");
  command.flag("--merge-alike", options->table.merges_alike,
               "With --counts: names that read alike are one, the first of them");
  command.flag("--pool-runs", options->table.pools_runs,
               "With --counts: several runs of one participant count together");
  command.flag("--pool-tasks", options->table.pools_tasks,
               "With --counts: several tasks, which a column names, count together");
  command.flag(
      "--count-practice", options->table.counts_practice,
      "With --counts: rows that a column calls practice, or not to be counted, count like others");
  command.flag("--are-counts", options->table.are_counts,
               "With --counts: numbers are counts even where they add up to 100, as percentages "
               "do, or one is the sum of the others");
  command.one_of(
      "--rows", options->rows, {"stimuli", "responses"},
      "With --counts: what the rows of a matrix stand for, if its header does not say it");
}
}  // namespace

void add_report(CommandParser& line) {
  Command command =
      line.add("report", "Confusion matrix and statistics: terminal, HTML, JSON and CSV");
  const auto options = std::make_shared<ReportOptions>();
  command.arguments("directories", options->directories,
                    "Directory of a study; several, if it was run on several machines; or the "
                    "server that has them (postgresql://USER@HOST/DATABASE)");
  command.option("--study", options->study,
                 "Of a server: title, or how the SHA-256 of the protocol begins");
  command.list("--counts", options->counts,
               "Instead of a study: a matrix, or tables with a row for each answer (CSV, also "
               "PsychoPy's and jsPsych's)");
  command.list("--compare", options->compared,
               "Instead of a study: two of them, or two tables, and how they differ");
  add_table_options(command, options);
  command.option("--out", options->out,
                 "Output directory; default: report in the study's own directory");
  command.one_of("--mode", options->mode, {"real", "pilot", "simulated"},
                 "Which sessions: real, pilot or simulated");
  command.option(
      "--only", options->only,
      "Only these parts, comma-separated: names of blocks, contrasts, groups, "
      "retest, mixed_models, confidence, sessions, procedures, questionnaires, rendered");
  command.flag(
      "--all", options->shows_all,
      "Print all, at a terminal too: the rows of all participants, and more than 60 lines");
  command.flag("--replace", options->replace, "Replace an earlier report");
  command.on_run([options] { run_report(*options); });
}
}  // namespace tapstudy::runner
