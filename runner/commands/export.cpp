#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "core/error.hpp"
#include "core/output_directory.hpp"
#include "core/output_file.hpp"
#include "protocols/axes/axis.hpp"
#include "results/export/study_export.hpp"
#include "results/export/study_tables.hpp"
#include "runner/build_info.hpp"
#include "runner/commands/commands.hpp"
#include "runner/experiments/stimulus_tables.hpp"
#include "runner/experiments/stored_protocol.hpp"
#include "runner/stimuli/model_library.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
namespace {
struct ExportOptions {
  std::string directory;
  std::string out;
  std::string format{"csv"};
  bool wants_traces{false};
};

std::map<std::string, std::string> units_of_axes() {
  std::map<std::string, std::string> units;
  for (const protocols::Axis& axis : protocols::axes()) {
    units.emplace(axis.name, axis.unit);
  }
  return units;
}

results::StudyExport study_export(results::Store& store) {
  const results::StudyRow study = store.study();
  StimulusTables stimuli = stimulus_tables(stored_protocol(study), models_of_this_user());
  if (!stimuli.without_model.empty()) {
    warn(
        fmt::format("no modes are listed of {}: their models are not cached (`tapstudy check` "
                    "builds them; then export again)",
                    fmt::join(stimuli.without_model, ", ")));
  }
  std::vector<results::Table> tables = results::study_tables(store, units_of_axes());
  std::ranges::move(stimuli.tables, std::back_inserter(tables));
  return {{study.title, study.protocol_sha256,
           fmt::format("tapstudy {} ({})", program_version(), git_hash())},
          study.protocol_text,
          std::move(tables),
          {}};
}

void run_export(const ExportOptions& options) {
  results::Store store = results::Store::open_existing(options.directory);
  store.at_one_moment([&] {
    if (store.answers().empty()) {
      throw core::InvalidInput{options.directory + ": holds no answers yet to export"};
    }
    results::StudyExport study = study_export(store);
    core::write_new_directory(options.out, [&](const std::string& directory) {
      if (options.wants_traces) {
        study.trials = results::trials_with_traces(store);
      }
      results::write_csv_files(directory, store, study);
    });
  });
  fmt::print("{}\n", options.out);
}
}  // namespace

void add_export(CommandParser& line) {
  Command command = line.add("export", "Write a study's data in standard formats");
  const auto options = std::make_shared<ExportOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.option("--out", options->out, "What to write; nothing is overwritten", Need::required);
  command.one_of("--format", options->format, {"csv"},
                 "csv (default): a directory of tidy tables with a data dictionary "
                 "(CSV on the Web: csv-metadata.json)");
  command.flag("--traces", options->wants_traces,
               "csv: every tick too, a file a trial (about 200 bytes a tick)");
  command.on_run([options] { run_export(*options); });
}
}  // namespace tapstudy::runner
