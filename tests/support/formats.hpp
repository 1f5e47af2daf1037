#pragma once
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/document/formats.hpp"
#include "analysis/report/statistic.hpp"
#include "support/catch.hpp"
namespace tapstudy::testing {
// A summary in each of its formats.
struct Formats {
  std::string text;
  std::string html;
  nlohmann::ordered_json json;
  std::map<std::string, std::string> csv;  // by file
};

// The page names exactly the publications that the summary's texts say they cite.
inline void check_citations(const std::string& page, const std::set<core::Source>& sources) {
  for (std::size_t place = 0; place < core::references.size(); ++place) {
    const core::Source source{place};
    const std::string key = analysis::escaped(std::string{source.reference().key});
    INFO(key);
    CHECK((page.find(key) != std::string::npos) == sources.contains(source));
  }
}

inline Formats formats_of(const analysis::BlockSummary& summary) {
  Formats formats;
  std::ostringstream text;
  summary.write_text(text);
  formats.text = text.str();
  std::ostringstream html;
  summary.write_words_html(html, 0);
  summary.write_html(html);
  summary.write_details_html(html);
  formats.html = html.str();
  check_citations(formats.html, summary.sources());
  formats.json = summary.as_json();
  for (const analysis::ReportTable* const table : csv_tables(summary.sections)) {
    std::ostringstream csv;
    write_table_csv(csv, *table);
    formats.csv[table->name + ".csv"] = csv.str();
  }
  return formats;
}

// By the row of the report's table.
inline Formats reported(const std::string& statistic, const analysis::BlockDesign& design,
                        const std::vector<results::AnswerRow>& answers) {
  return formats_of(*analysis::find_statistic(statistic).summarise(design, {answers, {}}));
}

// Characters of UTF-8 of the longest line.
inline std::size_t longest_line(const std::string& text) {
  std::istringstream lines{text};
  std::size_t longest = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto is_start = [](char c) { return (static_cast<unsigned char>(c) >> 6U) != 2U; };
    longest = std::max(longest,
                       static_cast<std::size_t>(std::count_if(line.begin(), line.end(), is_start)));
  }
  return longest;
}
}  // namespace tapstudy::testing
