#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "protocols/axes/axis.hpp"
#include "results/export/study_export.hpp"
#include "results/store/study_queries.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/session/stimuli/model_library.hpp"
#include "runner/studies/mixed_models/data.hpp"
#include "runner/studies/mixed_models/fit_in_r.hpp"
#include "runner/studies/protocol_tables.hpp"
#include "runner/studies/stored_results.hpp"
#include "runner/studies/stored_study.hpp"
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

std::vector<results::BlockText> block_texts(const protocols::Protocol& protocol) {
  std::vector<results::BlockText> texts;
  for (const protocols::Block& block : protocol.blocks) {
    results::BlockText text{
        block.name, block.question, block.instructions, {}, response_meanings(block, protocol)};
    for (const std::string& name : protocols::all_presented(block)) {
      text.stimuli.emplace_back(name, protocol.stimulus(name).label);
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

// The meanings of answers that are not their own text.
std::vector<results::Level> levels_of(const protocols::FormItem& item) {
  std::vector<results::Level> levels;
  for (const protocols::Option& option : item.options) {
    levels.emplace_back(option.name, option.label);
  }
  if (item.kind == protocols::ItemKind::likert) {
    levels = {{"1", item.low}, {std::to_string(item.steps), item.high}};
  } else if (item.kind == protocols::ItemKind::scale) {
    levels = {{"0", item.low}, {"1", item.high}};
  }
  std::erase_if(levels, [](const results::Level& level) { return level.second.empty(); });
  return levels;
}

std::vector<results::FormText> form_texts(const protocols::Protocol& protocol) {
  std::vector<results::FormText> texts;
  for (const auto& [name, form] : protocol.forms) {
    results::FormText text{name, form.title, {}};
    for (const protocols::FormItem& item : form.items) {
      text.items.push_back({item.name, item.question, levels_of(item),
                            item.kind == protocols::ItemKind::text, item.bids});
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

results::StudyExport study_export(results::Store& store, bool has_tables) {
  const results::StudyRow study = store.study();
  const protocols::Protocol protocol = checked_protocol(store);
  StimulusTables stimuli = stimulus_tables(protocol, user_model_cache());
  if (has_tables && !stimuli.without_model.empty()) {
    warn(
        fmt::format("no modes are listed of {}: their models are not cached (`tapstudy check` "
                    "builds them; then export again)",
                    fmt::join(stimuli.without_model, ", ")));
  }
  std::vector<results::Table> tables = results::study_tables(store, units_of_axes());
  std::ranges::move(stimuli.tables, std::back_inserter(tables));
  tables.push_back(tracks_table(protocol, store));
  return {{study.title, study.protocol_sha256,
           fmt::format("tapstudy {} ({})", program_version(), git_hash())},
          study.protocol_text,
          block_texts(protocol),
          std::move(tables),
          form_texts(protocol),
          {}};
}

// What mixed models are fitted to, and the script of R that does it.
void add_mixed_models(results::Store& store, results::StudyExport& study) {
  if (std::optional<results::Table> data =
          stored_mixed_models_data(store, checked_protocol(store))) {
    study.tables.push_back(std::move(*data));
    study.further_files.emplace_back("mixed_models.R", mixed_models_script());
  }
}

struct Format {
  const char* name;
  bool has_tables;  // of stimuli and their modes, too
  bool always_has_traces;
  bool has_scripts;
  void (*write)(const std::string& out, results::Store& store, const results::StudyExport& study);
};

const std::array formats{
    Format{"csv", true, false, true,
           [](const std::string& out, results::Store& store, const results::StudyExport& study) {
             core::write_new_directory(out, [&](const std::string& directory) {
               results::write_csv_files(directory, store, study);
             });
           }},
    Format{"hdf5", true, true, false,
           [](const std::string& out, results::Store& store, const results::StudyExport& study) {
             core::write_new_file_by(out, [&](const std::string& file) {
               results::write_hdf5_file(file, store, study);
             });
           }},
    Format{"bids", false, true, false,
           [](const std::string& out, results::Store& store, const results::StudyExport& study) {
             core::write_new_directory(out, [&](const std::string& directory) {
               results::write_bids_dataset(directory, store, study);
             });
           }},
};

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  std::ranges::transform(formats, std::back_inserter(names), &Format::name);
  return names;
}

void run_export(const ExportOptions& options) {
  core::check_is_new(options.out);
  results::Store store = results::Store::open_existing(options.directory);
  store.in_read_transaction([&] {
    if (results::stored_answers(store).empty()) {
      throw core::InvalidInput{options.directory + ": holds no answers yet to export"};
    }
    const Format& format = *std::ranges::find(formats, options.format, &Format::name);
    results::StudyExport study = study_export(store, format.has_tables);
    if (format.has_scripts) {
      add_mixed_models(store, study);
    }
    if (format.always_has_traces || options.wants_traces) {
      study.trials = results::trials_with_traces(store);
    }
    Progress progress{"writing " + options.out};
    study.count = progress.count();
    format.write(options.out, store, study);
  });
  fmt::print("{}\n", options.out);
}
}  // namespace

void add_export(CommandParser& line) {
  Command command = line.add("export", "Write a study's data in standard formats");
  const auto options = std::make_shared<ExportOptions>();
  command.argument("directory", options->directory, "Directory of a study", Need::required);
  command.option("--out", options->out, "What to write; nothing is overwritten", Need::required);
  command.one_of("--format", options->format, format_names(),
                 "csv (default): a directory of tidy tables and their data dictionary (CSV on the "
                 "Web); hdf5: one file of the same tables and all traces; bids: a dataset of the "
                 "Brain Imaging Data Structure, without names, notes and free text");
  command.flag(
      "--traces", options->wants_traces,
      "csv: every tick too, one file per trial (about 200 bytes a tick); the other formats "
      "always have them");
  command.on_run([options] { run_export(*options); });
}
}  // namespace tapstudy::runner
