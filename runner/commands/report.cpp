#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>

#include "analysis/report/writers.hpp"
#include "analysis/statistics/counts_csv.hpp"
#include "core/error.hpp"
#include "core/output_file.hpp"
#include "protocols/read_protocol.hpp"
#include "results/store.hpp"
#include "runner/commands/commands.hpp"
#include "runner/experiments/study_design.hpp"
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

Summary summary_of_study(const ReportOptions& options) {
  results::Store store = results::Store::open_existing(options.directory);
  const results::StudyRow study = store.study();
  const std::vector<results::SessionRow> sessions = store.sessions();
  const Mode mode = mode_to_report(options, sessions);
  std::vector<results::AnswerRow> answers = store.answers();
  std::erase_if(answers, [&](const results::AnswerRow& answer) {
    return answer.mode != mode || answer.is_practice;
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
  Summary summary = analysis::summarise(design_of(protocol), answers, visits);
  summary.provenance = provenance(study, sessions, mode);
  return summary;
}

Summary summary_of_counts(const std::string& file) {
  std::ifstream text{file};
  if (!text) {
    throw core::InvalidInput{file + ": cannot be read"};
  }
  Summary summary =
      analysis::summarise(analysis::read_counts(text, file), fs::path{file}.stem().string());
  summary.provenance = {{"counts", file}};
  return summary;
}

void write_files(const ReportOptions& options, const Summary& summary) {
  std::error_code error;
  fs::create_directories(options.out, error);
  if (!fs::is_directory(options.out, error)) {
    throw core::InvalidInput{options.out + ": cannot be made a directory"};
  }
  const auto write = [&](const std::string& name, const core::Write& content) {
    const std::string file = (fs::path{options.out} / name).string();
    if (options.replace) {
      core::replace_file(file, content);
    } else {
      core::write_new_file(file, content);
    }
    fmt::print("{}\n", file);
  };
  write("report.html", [&](std::ostream& out) { analysis::write_html(out, summary); });
  write("report.json", [&](std::ostream& out) { analysis::write_json(out, summary); });
  for (const auto& block : summary.blocks) {
    for (const analysis::CsvTable& table : block->tables()) {
      write(block->block.empty() ? table.name : block->block + "_" + table.name, table.write);
    }
  }
}

void run_report(ReportOptions options) {
  if (options.directory.empty() == options.counts.empty()) {
    throw core::InvalidInput{"report takes either the directory of a study or --counts FILE.csv"};
  }
  const Summary summary =
      options.counts.empty() ? summary_of_study(options) : summary_of_counts(options.counts);
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
  command.option("--out", options->out, "Output directory; default: the study's directory");
  command.one_of("--mode", options->mode, {"real", "pilot", "simulated"},
                 "Which sessions: real, pilot or simulated");
  command.flag("--replace", options->replace, "Replace an earlier report");
  command.on_run([options] { run_report(*options); });
}
}  // namespace tapstudy::runner
