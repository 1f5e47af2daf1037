#include "analysis/report/summary.hpp"

#include <sstream>

#include "analysis/report/document/block_summary.hpp"
#include "analysis/report/writers.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
ReportTable table_of_tests(const std::vector<std::optional<double>>& p, bool are_adjusted) {
  ReportTable table{"tests", "Tests", {column("of", "of"), column("p", "p")}};
  if (are_adjusted) {
    table.columns.push_back(column("after Holm", "p_holm"));
  }
  for (const auto& one : p) {
    table.rows.push_back({word("it"), probability(one)});
    if (are_adjusted) {
      table.rows.back().push_back(probability(one));
    }
  }
  return table;
}
}  // namespace

TEST_CASE("the head of a report counts its tests by how they are adjusted", "[analysis][report]") {
  BlockDesign design;
  const auto block = std::make_shared<BlockSummary>(design);
  block->hypotheses.resize(3);
  block->hypotheses[0].p = 0.2;
  block->hypotheses[1].p = 0.3;
  block->sections = {{"A", {table_of_tests({0.1, std::nullopt, 0.7}, false)}}};
  Summary summary;
  CHECK(tests_in_words(summary).empty());
  summary.blocks = {block};
  summary.sections = {{"B", {table_of_tests({0.1, 0.2, 0.9}, true)}}};
  CHECK(tests_in_words(summary) ==
        "This report holds 7 tests: 2 of declared hypotheses, adjusted for one another; 3 adjusted "
        "within their table; 2 neither declared nor adjusted (if nothing were true, about 0.1 of "
        "them would be below .05).");
}

TEST_CASE("a page begins with what comparisons found, before its contents", "[analysis][report]") {
  Summary summary;
  summary.sections = {{"Blocks compared"}};
  for (int i = 1; i <= 8; ++i) {
    summary.sections[0].findings.push_back("finding " + std::to_string(i));
  }
  std::ostringstream out;
  write_html(out, summary);
  const std::string page = out.str();
  const std::string head = page.substr(0, page.find("class=contents"));
  CHECK_THAT(head, Contains("<b>Blocks compared</b> (exploratory): finding 1; finding 2; ") &&
                       Contains("finding 3; the others stand in the tables.") &&
                       !Contains("finding 4"));
  constexpr std::size_t too_many = 40;
  summary.sections[0].remarks.assign(too_many, "A remark.");
  std::ostringstream within;
  constexpr std::size_t terminal_lines = 20;
  write_text_within(within, summary, terminal_lines, terminal_lines);
  CHECK_THAT(within.str(), Contains("Blocks compared\n  finding 1"));
}

TEST_CASE("of several blocks the contents are folded, and figures come before their tables",
          "[analysis][report]") {
  Summary summary;
  for (const char* const name : {"first", "second"}) {
    BlockDesign design;
    design.name = name;
    const auto block = std::make_shared<BlockSummary>(design);
    block->results().tables = {table_of_tests({0.1}, false)};
    block->results().charts = {{"A figure", "", "x", "y", {0.0, 1.0}, {0.0, 1.0}}};
    summary.blocks.push_back(block);
  }
  const auto page_of = [&] {
    std::ostringstream out;
    write_html(out, summary);
    return out.str();
  };
  const std::string page = page_of();
  CHECK_THAT(page, Contains("<details><summary>Contents</summary>"));
  CHECK_THAT(page, !Contains("word-break"));  // breaks words that have room on the next line
  CHECK(page.find("<svg class=chart") < page.find("<h3>Tests</h3>"));
  summary.blocks.pop_back();
  CHECK_THAT(page_of(), !Contains("<summary>Contents</summary>"));
}
