#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "results/export/csv_file.hpp"
#include "results/export/study_export.hpp"
namespace tapstudy::results {
namespace {
using Json = nlohmann::ordered_json;
constexpr const char* context = "http://www.w3.org/ns/csvw";

const char* datatype(CellType type) {
  switch (type) {
    case CellType::boolean:
      return "boolean";
    case CellType::integer:
      return "integer";
    case CellType::real:
      return "double";
    case CellType::text:
      return "string";
  }
  return "";
}

Json schema_of(const std::vector<Column>& columns) {
  Json schema;
  for (const Column& column : columns) {
    Json described{{"name", column.name},
                   {"titles", column.name},
                   {"datatype", datatype(column.type)},
                   {"null", missing_in_csv},
                   {"dc:description", column.description}};
    if (!column.unit.empty()) {
      described["schema:unitText"] = column.unit;
    }
    schema["columns"].push_back(described);
  }
  return schema;
}
}  // namespace

std::string csvw_schema(const std::vector<Column>& columns) {
  Json schema = schema_of(columns);
  schema["@context"] = context;
  return schema.dump(2) + "\n";
}

std::string csvw_metadata(const Provenance& provenance, const std::vector<DescribedFile>& files) {
  Json metadata{{"@context", context},
                {"dc:title", provenance.title},
                {"dc:source", "protocol of SHA-256 " + provenance.protocol_sha256},
                {"dc:creator", provenance.program},
                {"rdfs:comment",
                 "So that spreadsheets run no text as a formula, one that begins with = + - @, a "
                 "tab or a line break and is no number has an apostrophe before it, which belongs "
                 "not to the text; one that begins with apostrophes before these has one more."},
                {"dialect", {{"encoding", "utf-8"}, {"header", true}, {"doubleQuote", true}}}};
  for (const DescribedFile& file : files) {
    Json table{{"url", file.url}, {"dc:description", file.description}};
    if (file.schema_url.empty()) {
      table["tableSchema"] = schema_of(file.columns);
    } else {
      table["tableSchema"] = file.schema_url;
    }
    metadata["tables"].push_back(table);
  }
  return metadata.dump(2) + "\n";
}

namespace {
namespace fs = std::filesystem;

void write_table(const fs::path& file, const Table& table) {
  core::write_new_file(file.string(), [&](std::ostream& out) { write_csv(out, table); });
}

void write_traces(const fs::path& directory, Store& store, const StudyExport& study,
                  std::vector<DescribedFile>& files) {
  if (study.trials.empty()) {
    return;
  }
  const std::vector<Recording> all = recordings(store);
  const auto schema = [](const Recording& recording) {
    return (recording.name == "traces" ? "trace" : recording.name) + ".schema.json";
  };
  for (const Recording& recording : all) {
    core::make_directories((directory / recording.name).string());
    core::write_new_file(directory / schema(recording), csvw_schema(recording.columns));
  }
  each_traced_trial(study, [&](std::int64_t trial) {
    for (const Recording& recording : all) {
      if (const std::optional<Table> table = recording.of_trial(trial)) {
        const std::string name = recording.name + "/" + table->name + ".csv";
        write_table(directory / name, *table);
        files.push_back({name, table->description, schema(recording), {}});
      }
    }
  });
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
  for (const auto& [name, text] : study.further_files) {
    core::write_new_file(root / name, text);
  }
}
}  // namespace tapstudy::results
