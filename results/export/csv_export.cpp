#include <filesystem>

#include "core/error.hpp"
#include "core/output_directory.hpp"
#include "core/output_file.hpp"
#include "results/export/csv_file.hpp"
#include "results/export/study_export.hpp"
#include "results/export/study_tables.hpp"
namespace tapstudy::results {
namespace {
namespace fs = std::filesystem;
constexpr const char* trace_schema = "trace.schema.json";

void write_table(const fs::path& file, const Table& table) {
  core::write_new_file(file.string(), [&](std::ostream& out) { write_csv(out, table); });
}

void write_traces(const fs::path& directory, Store& store, const StudyExport& study,
                  std::vector<DescribedFile>& files) {
  if (study.trials.empty()) {
    return;
  }
  core::make_directories((directory / "traces").string());
  for (const std::int64_t trial : study.trials) {
    const Table trace = trace_table(store, trial);
    const std::string name = "traces/" + trace.name + ".csv";
    write_table(directory / name, trace);
    files.push_back({name, trace.description, trace_schema, {}});
  }
  core::write_new_file(directory / trace_schema, csvw_schema(trace_columns()));
}
}  // namespace

void write_csv_files(const std::string& directory, Store& store, const StudyExport& study) {
  const fs::path root{directory};
  std::vector<DescribedFile> files;
  for (const Table& table : study.tables) {
    write_table(root / (table.name + ".csv"), table);
    files.push_back({table.name + ".csv", table.description, {}, table.columns});
  }
  write_traces(root, store, study, files);
  core::write_new_file(root / "csv-metadata.json", csvw_metadata(study.provenance, files));
  core::write_new_file(root / "protocol.yaml", study.protocol_text);
}
}  // namespace tapstudy::results
