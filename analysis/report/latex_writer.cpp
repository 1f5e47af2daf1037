#include <algorithm>
#include <cctype>

#include "analysis/report/writers.hpp"
#include "analysis/tables/table_writers.hpp"
#include "core/print.hpp"
namespace tapstudy::analysis {
namespace {
// Of letters, digits and hyphens.
std::string label_of(const std::string& block, const std::string& table) {
  std::string label = block.empty() ? table : block + "-" + table;
  std::ranges::replace_if(
      label, [](unsigned char c) { return c > 127 || std::isalnum(c) == 0; }, '-');
  return label;
}

void write_tables(std::ostream& out, const std::string& block,
                  const std::vector<ReportTable>& tables) {
  for (const ReportTable& table : tables) {
    if (!table.is_for_programs && !table.rows.empty()) {
      out << '\n';
      write_table_latex(out, table, label_of(block, table.name));
    }
  }
}
}  // namespace

void write_latex(std::ostream& out, const Summary& summary) {
  out << "% Each table to be copied or \\input; they take \\usepackage{booktabs} and UTF-8.\n";
  core::print(out, "% {}\n", latex_text(summary.title));
  if (const std::string warning = banner(summary); !warning.empty()) {
    core::print(out, "% {}\n", warning);
  }
  for (const auto& block : summary.blocks) {
    write_tables(out, block->block, block->report_tables());
  }
  for (const ReportSection& section : summary.sections) {
    write_tables(out, "", section.tables);
  }
}
}  // namespace tapstudy::analysis
