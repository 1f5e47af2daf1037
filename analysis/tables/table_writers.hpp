#pragma once
#include <nlohmann/json_fwd.hpp>
#include <ostream>

#include "analysis/tables/cells.hpp"
namespace tapstudy::analysis {
// One table in each format.
void write_table_text(std::ostream& out, const ReportTable& table);  // in 100 columns
// A wide table scrolls within its own frame, which the keyboard reaches.
void write_table_html(std::ostream& out, const ReportTable& table);
void write_table_csv(std::ostream& out, const ReportTable& table);  // a header of keys
nlohmann::ordered_json table_json(const ReportTable& table);        // [{key: value}]
}  // namespace tapstudy::analysis
