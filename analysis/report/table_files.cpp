#include "analysis/report/table_files.hpp"

#include <set>
#include <sstream>

#include "analysis/statistics/counts_csv.hpp"
namespace tapstudy::analysis {
namespace {
std::string text_of(const Summary& summary, const CsvTable& table) {
  std::ostringstream text;
  if (!banner(summary).empty()) {
    text << mode_mark << words_of_modes(summary) << '\n';
  }
  table.write(text);
  return text.str();
}
}  // namespace

// A block may have a name that makes its tables those of a section, or of another block.
std::vector<TableFile> table_files(const Summary& summary) {
  std::vector<TableFile> files;
  std::set<std::string> taken;
  for (const CsvTable& table : csv_of(summary.sections)) {
    taken.insert(table.name);
  }
  for (const auto& block : summary.blocks) {
    for (const CsvTable& table : block->tables()) {
      std::string name = block->block.empty() ? table.name : block->block + "_" + table.name;
      while (!taken.insert(name).second) {
        name = "block_" + name;
      }
      files.push_back({name, text_of(summary, table)});
    }
  }
  for (const CsvTable& table : csv_of(summary.sections)) {
    files.push_back({table.name, text_of(summary, table)});
  }
  return files;
}
}  // namespace tapstudy::analysis
