#pragma once
#include <ostream>
#include <string>
#include <vector>

#include "analysis/report/summary.hpp"
namespace tapstudy::analysis {
// Output formats. Each writes the whole summary; none computes anything.
void write_text(std::ostream& out, const Summary& summary);   // for a terminal
void write_html(std::ostream& out, const Summary& summary);   // self-contained, for a browser
void write_latex(std::ostream& out, const Summary& summary);  // tables to be copied from
void write_json(std::ostream& out, const Summary& summary);   // for programs; schema_version 1
// The full references of what the page cites, by author.
std::vector<std::string> references_of(const Summary& summary);
}  // namespace tapstudy::analysis
