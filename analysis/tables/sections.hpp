#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/blocks/block_summary.hpp"
#include "analysis/tables/cells.hpp"
#include "analysis/tables/chart.hpp"
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
}  // namespace tapstudy::analysis
