#include "analysis/report/study/retest.hpp"

#include <fmt/format.h>

#include "analysis/statistics/population/test_retest.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
using Blocks = std::vector<std::shared_ptr<const BlockSummary>>;

Blocks two_days(bool is_ratio, const std::map<std::string, double>& first,
                const std::map<std::string, double>& second) {
  Blocks blocks;
  for (const auto& [day, values] : {std::pair{"test.day_1", first}, {"test.day_2", second}}) {
    BlockDesign design;
    design.name = day;
    auto block = std::make_shared<BlockSummary>(design);
    block->personal = PersonalValues{is_ratio ? "threshold" : "share", is_ratio, values};
    blocks.push_back(block);
  }
  return blocks;
}

const std::vector<RepeatedBlock> test_of_two_days{{"test", {"test.day_1", "test.day_2"}}};

double number_of(const Cell& cell, std::size_t i) {
  return std::get<double>(cell.values[i]);
}
}  // namespace

TEST_CASE("a block done again is held against the first of those who did both",
          "[analysis][report][retest]") {
  const auto blocks = two_days(false, {{"A", 0.5}, {"B", 0.625}, {"C", 0.875}, {"D", 1.0}},
                               {{"A", 0.75}, {"B", 0.625}, {"C", 1.0}});
  const auto section = retest_section(blocks, test_of_two_days);
  REQUIRE(section);
  REQUIRE(section->tables[0].rows.size() == 1);
  const auto& row = section->tables[0].rows.front();
  REQUIRE(row.size() == section->tables[0].columns.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    CHECK(row[i].values.size() == section->tables[0].columns[i].keys.size());
  }
  const std::vector<double> first{0.5, 0.625, 0.875};
  const std::vector<double> second{0.75, 0.625, 1.0};
  const LimitsOfAgreement limits = limits_of_agreement(first, second);
  CHECK(row[1].text == "test.day_1");
  CHECK(number_of(row[3], 0) == Approx(0.125));
  CHECK(number_of(row[4], 0) == Approx(limits.limits.low));
  CHECK(number_of(row[4], 5) == Approx(limits.high_interval->high));
  CHECK(number_of(row[5], 0) == Approx(intraclass_correlation({first, second})->value));
  CHECK(std::get<std::int64_t>(row[6].values[0]) == 3);
  CHECK(section->tables[1].rows.empty());
  CHECK_THAT(section->findings.at(0),
             Contains("share, from test.day_1 to test.day_2: mean difference 0.125, 95 % CI ") &&
                 Contains("; ICC ") && Contains("; 3 participants"));
}

TEST_CASE("thresholds of two sessions are compared by their ratio", "[analysis][report][retest]") {
  const auto blocks =
      two_days(true, {{"A", 1.0}, {"B", 2.0}, {"C", 4.0}}, {{"A", 2.0}, {"B", 4.0}, {"C", 8.0}});
  const auto section = retest_section(blocks, test_of_two_days);
  REQUIRE(section);
  REQUIRE(section->tables[1].rows.size() == 1);
  CHECK(number_of(section->tables[1].rows.front()[3], 0) == Approx(2.0));
  CHECK(number_of(section->tables[1].rows.front()[4], 3) == Approx(2.0));
}

TEST_CASE("whoever came once is no retest, and of one person nothing can be said",
          "[analysis][report][retest]") {
  CHECK_FALSE(
      retest_section(two_days(false, {{"A", 0.5}, {"B", 0.5}}, {{"C", 0.5}}), test_of_two_days));
  CHECK_FALSE(
      retest_section(two_days(false, {{"A", 0.5}, {"B", 0.5}}, {{"A", 0.5}, {"B", 0.75}}), {}));
  const auto one = retest_section(
      two_days(false, {{"A", 0.5}, {"B", 0.5}}, {{"C", 0.5}, {"A", 0.75}}), test_of_two_days);
  REQUIRE(one);
  CHECK(one->tables[0].rows.empty());
  REQUIRE(one->remarks.size() == 1);
  CHECK_THAT(one->remarks.front().words, Contains("share in test.day_1 and test.day_2 only one "
                                                  "participant has both values"));
}

TEST_CASE("where all shares are at one end no change can be seen, and there are no limits of it",
          "[analysis][report][retest]") {
  const double end = GENERATE(0.0, 1.0);
  const std::map<std::string, double> at_end{{"A", end}, {"B", end}, {"C", end}};
  const auto row_of = [](const Blocks& blocks) {
    return retest_section(blocks, test_of_two_days)->tables[0].rows.front();
  };
  Blocks blocks;
  for (const auto& block : two_days(false, at_end, at_end)) {
    auto of_shares = std::make_shared<BlockSummary>(*block);
    of_shares->personal->scale = Interval{0.0, 1.0};
    blocks.push_back(of_shares);
  }
  const auto row = row_of(blocks);
  CHECK(row[4].text == "no limits");
  CHECK(row[4].values == std::vector<Value>(6));
  const auto remarks = retest_section(blocks, test_of_two_days)->remarks;
  REQUIRE(remarks.size() == 3);
  CHECK_THAT(remarks[1].words, Contains("no limits of agreement of share in test.day_1 and "));
  CHECK_THAT(remarks[2].words, Contains("no intra-class correlation of share in test.day_1 and ") &&
                                   Contains("do not differ"));
  // of a measure without ends all might have changed
  CHECK(std::get<double>(row_of(two_days(false, at_end, at_end))[4].values[0]) == 0.0);
}

TEST_CASE("of a block with parts each part is held against the same part of the other session",
          "[analysis][report][retest]") {
  Blocks parts;
  for (const std::string day : {"test.day_1", "test.day_2"}) {
    for (const double at : {3.0, 6.0}) {
      BlockDesign design;
      design.name = fmt::format("{}_at_mass_{}", day, at);
      design.part_of = day;
      auto part = std::make_shared<BlockSummary>(design);
      const double factor = day == "test.day_1" ? 1.0 : at;
      part->personal = PersonalValues{"threshold", true, {{"A", factor}, {"B", 2.0 * factor}}};
      parts.push_back(part);
    }
  }
  const auto section = retest_section(parts, test_of_two_days);
  REQUIRE(section);
  REQUIRE(section->tables[1].rows.size() == 2);
  CHECK(section->tables[1].rows[0][1].text == "test.day_1_at_mass_3");
  CHECK(section->tables[1].rows[0][2].text == "test.day_2_at_mass_3");
  CHECK(number_of(section->tables[1].rows[0][3], 0) == Approx(3.0));
  CHECK(number_of(section->tables[1].rows[1][3], 0) == Approx(6.0));
}
