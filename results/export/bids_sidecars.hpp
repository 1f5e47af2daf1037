#pragma once
#include <string>
#include <vector>

#include "results/export/study_export.hpp"
namespace tapstudy::results {
// The JSON files of a BIDS dataset.
std::string dataset_description(const Provenance& provenance);
// Of a table: each column's Description, Units, and Levels where they are known.
struct DescribedColumn {
  Column column;
  std::vector<std::pair<std::string, std::string>> levels{};
};
std::string table_sidecar(const std::vector<DescribedColumn>& columns);
// Of a questionnaire: what it is, and its columns.
std::string phenotype_sidecar(const std::string& tool, const std::vector<DescribedColumn>& columns);
std::string task_sidecar(const std::string& task, const BlockText& block,
                         const std::vector<DescribedColumn>& columns);
std::string recording_sidecar(double rate_hz, const std::vector<Column>& columns);
}  // namespace tapstudy::results
