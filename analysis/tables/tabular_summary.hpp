#pragma once
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/tables/cells.hpp"
#include "analysis/tables/chart.hpp"
namespace tapstudy::analysis {
// A summary as tables, sentences and figures. Every format is made from the same cells: text and
// HTML show their words, JSON and CSV their values. Text has the figures' tables instead.
class TabularSummary final : public BlockSummary {
 public:
  using BlockSummary::BlockSummary;
  void write_text(std::ostream& out) const override;  // in 100 columns
  void write_html(std::ostream& out) const override;
  // {"block", "task", TABLE: [{key: value}], "remarks": [sentence], "hypotheses"}
  nlohmann::ordered_json as_json() const override;
  std::vector<CsvTable> tables() const override;  // TABLE.csv, a header of keys
  std::vector<ReportTable> report_tables() const override { return parts; }
  std::vector<Chart> figures() const override { return charts; }
  std::vector<MainResult> main_results() const override { return main; }

  std::vector<ReportTable> parts;    // those without rows are left out for people
  std::vector<std::string> remarks;  // how it was computed, and what could not be
  std::vector<Chart> charts;
  std::vector<MainResult> main;
};
}  // namespace tapstudy::analysis
