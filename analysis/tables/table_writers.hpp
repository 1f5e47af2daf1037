#pragma once
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// One table in each format.
void write_table_text(std::ostream& out, const ReportTable& table);  // in 100 columns
// A wide table scrolls within its own frame, which the keyboard reaches.
void write_table_html(std::ostream& out, const ReportTable& table);
void write_table_csv(std::ostream& out, const ReportTable& table);  // a header of keys
// A float with rules of the package booktabs; `label` without special characters.
void write_table_latex(std::ostream& out, const ReportTable& table, const std::string& label);
// The columns that people see: those with a heading and, where there are rows, something in one.
std::vector<std::size_t> shown_columns(const ReportTable& table);
// Names and words, which are read from the left.
bool is_text_column(const ReportTable& table, std::size_t column);
// Text as LaTeX shows it.
std::string latex_text(std::string_view text);
nlohmann::ordered_json table_json(const ReportTable& table);  // [{key: value}]
}  // namespace tapstudy::analysis
