#pragma once
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/cells.hpp"
namespace tapstudy::analysis {
// Text elements shared by the block summaries.
inline constexpr std::size_t terminal_columns = 100;
// In characters of UTF-8, each as wide as any other.
std::size_t text_width(const std::string& text);
// Broken between words into lines of at most so many characters, the second and further behind so
// many spaces. A longer word has a line of its own.
std::vector<std::string> lines_of(const std::string& text, std::size_t width,
                                  std::size_t hanging = 0);
// The same in lines of at most terminal_columns behind so many spaces, the second and further lines
// two more; each ends with a line end.
std::string wrapped(const std::string& text, std::size_t indent);
void write_hypotheses_text(std::ostream& out, const std::vector<HypothesisResult>& hypotheses);

// HTML elements shared by the block summaries.
std::string escaped(const std::string& text);
// The same, where a number is not parted from its sign or its unit: with minus signs, and spaces
// that do not break.
std::string escaped_numbers(const std::string& text);
// A page that needs nothing beside it: what comes before its contents, and after. more_style: CSS.
void begin_page(std::ostream& out, const std::string& title, const std::string& more_style = {});
void end_page(std::ostream& out,
              const std::vector<std::pair<std::string, std::string>>& provenance);

// JSON elements shared by the block summaries.
nlohmann::ordered_json as_json(const Proportion& proportion);
nlohmann::ordered_json as_json(const std::vector<HypothesisResult>& hypotheses);

// One table in each format.
// In 100 columns. Rows of participants that would take it beyond so many lines are left out and
// counted.
void write_table_text(std::ostream& out, const ReportTable& table,
                      std::size_t most_lines = all_lines);
// A wide table scrolls within its own frame, which the keyboard reaches.
void write_table_html(std::ostream& out, const ReportTable& table);
void write_framed_html(std::ostream& out, const ReportTable& table);  // without title and note
void write_table_csv(std::ostream& out, const ReportTable& table);    // a header of keys
// A float with rules of the package booktabs; `label` without special characters.
void write_table_latex(std::ostream& out, const ReportTable& table, const std::string& label);
// The columns that people see: those with a heading and, where there are rows, something in one.
std::vector<std::size_t> shown_columns(const ReportTable& table);
bool has_rows_of_participants(const ReportTable& table);
// Names and words, which are read from the left.
bool is_text_column(const ReportTable& table, std::size_t column);
// Text as LaTeX shows it.
std::string latex_text(std::string_view text);
nlohmann::ordered_json table_json(const ReportTable& table);  // [{key: value}]
}  // namespace tapstudy::analysis
