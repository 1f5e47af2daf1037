#include "analysis/report/table_files.hpp"

#include <sstream>

#include "analysis/statistics/counts_csv.hpp"
namespace tapstudy::analysis {
namespace {
std::string text_of(const Summary& summary, const CsvTable& table) {
  std::ostringstream text;
  if (!banner(summary).empty()) {
    text << mode_mark << summary.modes << '\n';
  }
  table.write(text);
  return text.str();
}
}  // namespace

std::vector<TableFile> table_files(const Summary& summary) {
  std::vector<TableFile> files;
  for (const auto& block : summary.blocks) {
    for (const CsvTable& table : block->tables()) {
      files.push_back({block->block.empty() ? table.name : block->block + "_" + table.name,
                       text_of(summary, table)});
    }
  }
  for (const CsvTable& table : csv_of(summary.sections)) {
    files.push_back({table.name, text_of(summary, table)});
  }
  return files;
}
}  // namespace tapstudy::analysis
