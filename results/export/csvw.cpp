#include "results/export/csvw.hpp"

#include <nlohmann/json.hpp>

#include "results/export/csv_file.hpp"
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
}  // namespace tapstudy::results
