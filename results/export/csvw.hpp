#pragma once
#include <string>
#include <vector>

#include "results/export/table.hpp"
namespace tapstudy::results {
struct Provenance {
  std::string title;            // of the study
  std::string protocol_sha256;  // of the protocol's text
  std::string program;          // name, version and revision of what wrote the export
};

// A file of an export and what is in it.
struct DescribedFile {
  std::string url;          // relative to the metadata
  std::string description;  // of the table
  std::string schema_url;   // of a file with the columns; empty: they are here
  std::vector<Column> columns;
};

// The data dictionary as metadata of the W3C's "CSV on the Web" (Metadata Vocabulary for Tabular
// Data, 2015): datatype, description (dc:description) and unit (schema:unitText) of each column,
// and what stands for a missing value.
std::string csvw_metadata(const Provenance& provenance, const std::vector<DescribedFile>& files);
// The schema alone, for files that share it.
std::string csvw_schema(const std::vector<Column>& columns);
}  // namespace tapstudy::results
