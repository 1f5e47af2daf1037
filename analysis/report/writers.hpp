#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
// Output formats. Each writes the whole summary; none computes anything.
// For a terminal; most_lines: of a table.
void write_text(std::ostream& out, const Summary& summary, std::size_t most_lines = all_lines);
// The same in so many lines at most: where it would be longer, what the blocks were made to find
// out and what was declared, then as many of the first tables as there is room for.
void write_text_within(std::ostream& out, const Summary& summary, std::size_t lines,
                       std::size_t most_lines);
void write_html(std::ostream& out, const Summary& summary);   // self-contained, for a browser
void write_latex(std::ostream& out, const Summary& summary);  // tables to be copied from
void write_json(std::ostream& out, const Summary& summary);   // for programs; schema_version 1
// The full references of what the page cites, by author.
std::vector<std::string> references_of(const Summary& summary);

struct FigureFile {
  std::string name;  // letters, digits, - and _; unlike all others
  std::string svg;
};
// Every figure of a report as a file of its own, those behind "More figures" too. Marks within
// tables are no figures. Where participants are not those of a study, each says so.
std::vector<FigureFile> figure_files(const Summary& summary);

struct TableFile {
  std::string name;
  std::string text;  // CSV
};
// The tables of a report; one that leaves it still says whose answers it holds.
std::vector<TableFile> table_files(const Summary& summary);
}  // namespace tapstudy::analysis
