#include "analysis/report/summary.hpp"

#include "analysis/report/document/block_summary.hpp"
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
