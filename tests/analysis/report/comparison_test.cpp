#include "analysis/report/comparison.hpp"

#include <cmath>
#include <limits>

#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "support/catch.hpp"
using namespace tapstudy;
using analysis::PersonalValues;

namespace {
using Blocks = std::vector<std::shared_ptr<const analysis::BlockSummary>>;

void add(Blocks& blocks, const std::string& name, const PersonalValues& values,
         const std::string& part_of = "") {
  analysis::BlockDesign design;
  design.name = name;
  design.part_of = part_of;
  auto block = std::make_shared<analysis::BlockSummary>(design);
  block->personal = values;
  blocks.push_back(block);
}

std::vector<double> numbers(const analysis::Cell& cell) {
  std::vector<double> found;
  for (const analysis::Value& value : cell.values) {
    const auto* const whole = std::get_if<std::int64_t>(&value);
    found.push_back(whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value));
  }
  return found;
}
}  // namespace

TEST_CASE("blocks of one measure are compared by the differences of who did both",
          "[analysis][report]") {
  Blocks blocks;
  add(blocks, "a", {"share", false, {{"P1", 0.5}, {"P2", 0.75}, {"P3", 1.0}, {"only a", 0.0}}});
  add(blocks, "b", {"share", false, {{"P1", 0.25}, {"P2", 0.75}, {"P3", 0.5}, {"only b", 1.0}}});
  add(blocks, "other", {"threshold", true, {{"P1", 0.5}, {"P2", 0.75}}});
  const auto section = analysis::block_contrasts(blocks, true);
  REQUIRE(section);
  REQUIRE(section->tables[0].rows.size() == 1);
  CHECK(section->tables[1].rows.empty());
  const auto& row = section->tables[0].rows[0];
  CHECK(row[1].text == "a");
  CHECK(row[2].text == "b");
  const auto expected = analysis::paired_contrast({0.25, 0.0, 0.5}, 1);
  CHECK(numbers(row[3]) ==
        std::vector{expected.mean, expected.interval->low, expected.interval->high});
  CHECK(row[4].text == "3");
  CHECK(numbers(row[4]) == std::vector{3.0, 3.0});
  CHECK(section->remarks.size() == 2);
  CHECK(analysis::block_contrasts(blocks, false)->remarks.size() == 1);
}

TEST_CASE("thresholds are compared by their geometric mean ratio, and all pairs are adjusted for",
          "[analysis][report]") {
  Blocks blocks;
  std::map<std::string, double> doubled;
  std::map<std::string, double> single;
  for (int i = 0; i < 8; ++i) {
    const std::string id = "P" + std::to_string(i);
    single[id] = 0.1 * (i + 1);
    doubled[id] = 2.0 * single[id] * (i % 2 == 0 ? 1.25 : 0.8);
  }
  add(blocks, "a", {"threshold", true, doubled});
  add(blocks, "b", {"threshold", true, single});
  add(blocks, "c", {"threshold", true, single});
  const auto section = analysis::block_contrasts(blocks, false);
  REQUIRE(section);
  const auto& rows = section->tables[1].rows;
  REQUIRE(rows.size() == 3);
  CHECK(numbers(rows[0][3])[0] == Approx(2.0));  // 1.25 and 0.8 have the geometric mean 1
  CHECK(std::get<double>(rows[0][5].values[0]) == Approx(2.0 / 256.0));  // all one sign, of 2^8
  CHECK(std::get<double>(rows[0][6].values[0]) == Approx(3.0 * 2.0 / 256.0));
  CHECK(std::get<double>(rows[2][5].values[0]) == 1.0);  // equal values
  CHECK_THAT(section->findings.at(0), Contains("a against b: mean ratio 2, 95 % CI ") &&
                                          Contains("; p = .008, p = .023 after Holm 1979; 8 "
                                                   "participants"));
}

TEST_CASE("who lies beyond the levels takes part in a comparison, by order and by likelihood",
          "[analysis][report]") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  PersonalValues easy{"threshold", true, {}, {}, {}};
  PersonalValues hard{"threshold", true, {}, {}, {}};
  for (int i = 0; i < 8; ++i) {
    const std::string id = "P" + std::to_string(i);
    easy.by_participant[id] = 0.1 * (1.0 + 0.1 * i);
    if (i < 2) {
      hard.by_participant[id] = 0.3;
    } else {
      hard.beyond[id] = {0.5, infinity};
    }
  }
  Blocks blocks;
  add(blocks, "hard", hard);
  add(blocks, "easy", easy);
  const auto section = analysis::block_contrasts(blocks, false);
  REQUIRE(section);
  const auto& row = section->tables[1].rows.at(0);
  CHECK(row[4].text == "8");
  CHECK(std::get<double>(row[5].values[0]) == Approx(2.0 / 256.0));  // all of one sign
  const std::vector<double> ratio = numbers(row[3]);
  CHECK(ratio[0] > 3.0);
  CHECK(ratio[1] > 1.0);
  REQUIRE(section->findings.size() == 1);
  CHECK_THAT(section->findings[0],
             Contains("threshold: hard against easy: mean ratio ") &&
                 Contains("; p = .008; 8 participants, 6 of them beyond the levels"));
  hard.beyond.erase("P7");
  hard.participants = {"P7"};
  blocks.clear();
  add(blocks, "hard", hard);
  add(blocks, "easy", easy);
  const auto of_seven = analysis::block_contrasts(blocks, false);
  CHECK(of_seven->tables[1].rows.at(0)[4].text == "7 of 8");
  CHECK_THAT(of_seven->findings[0], Contains("; 7 of 8 participants, 5 of them beyond the levels"));
}

TEST_CASE("a part is compared with the other parts of its block, and nothing with nothing",
          "[analysis][report]") {
  Blocks blocks;
  const PersonalValues values{"threshold", true, {{"P1", 0.1}, {"P2", 0.2}}};
  add(blocks, "jnd", values);
  add(blocks, "jnd at 1", values, "jnd");
  CHECK_FALSE(analysis::block_contrasts(blocks, false));
  add(blocks, "jnd at 2", values, "jnd");
  CHECK(analysis::block_contrasts(blocks, false)->tables[1].rows.size() == 1);
  blocks.clear();
  add(blocks, "a", {"share", false, {{"P1", 0.5}}});
  add(blocks, "b", {"share", false, {{"P2", 0.5}}});
  CHECK_FALSE(analysis::block_contrasts(blocks, false));
}
