#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/chart.hpp"
namespace tapstudy::analysis {
// A part of a long report: tables, figures and sentences under one heading.
struct ReportSection {
  std::string title;
  std::vector<ReportTable> tables{};  // those without rows are left out for people
  std::vector<Chart> charts{};
  std::vector<std::string> remarks{};  // how it was computed, and what could not be
  std::vector<Chart> folded_charts{};  // shown on demand
  bool is_detail{};                    // for the page and files; not printed beside results
  std::string name{};                  // by which it is asked for, where it is of a whole study
};

// Titles, tables and remarks; figures are left out.
void write_sections_text(std::ostream& out, const std::vector<ReportSection>& sections);
// A list of contents with links where there are several, then the sections. `anchor`: of the block,
// unlike that of others.
void write_sections_html(std::ostream& out, const std::vector<ReportSection>& sections,
                         const std::string& anchor);
// Every table under its name, and "remarks".
void add_sections(nlohmann::ordered_json& json, const std::vector<ReportSection>& sections);
// TABLE.csv of every table; the sections outlive what is returned.
std::vector<CsvTable> csv_of(const std::vector<ReportSection>& sections);

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
