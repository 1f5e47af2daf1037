#include <fmt/format.h>

#include "analysis/blocks/wording.hpp"
#include "analysis/identification/identification_summary.hpp"
namespace tapstudy::analysis {
namespace {
ReportTable matrix_table(const ConfusionMatrix& matrix) {
  ReportTable table{"matrix", "Answers to each stimulus", {column("presented", "stimulus")}};
  for (const Item& response : matrix.responses) {
    table.columns.push_back(column(response.label, response.name));
  }
  for (std::size_t i = 0; i < matrix.stimuli.size(); ++i) {
    std::vector<Cell> row{word(matrix.stimuli[i].label)};
    for (const std::int64_t counted : matrix.counts[i]) {
      const Proportion share{counted, matrix.row_total(i)};
      row.push_back({fmt::format("{} ({})", counted, percent(share)), {counted}});
    }
    table.rows.push_back(row);
  }
  return table;
}
}  // namespace

std::vector<ReportTable> IdentificationSummary::report_tables() const {
  std::vector<ReportTable> tables{matrix_table(matrix)};
  for (const ReportSection& section : sections) {
    tables.insert(tables.end(), section.tables.begin(), section.tables.end());
  }
  return tables;
}

std::vector<Chart> IdentificationSummary::figures() const {
  std::vector<Chart> charts;
  for (const ReportSection& section : sections) {
    charts.insert(charts.end(), section.charts.begin(), section.charts.end());
  }
  return charts;
}
}  // namespace tapstudy::analysis
