#include "analysis/statistics/population/independent_groups.hpp"

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

namespace {
using Values = std::vector<double>;

// Of R: p of all assignments by Welch's t, and the interval of t.test.
const std::string all_assignments =
    "welch <- function(a, b) { d <- mean(a) - mean(b); v <- var(a) / length(a) + var(b) / "
    "length(b); if (abs(d) < 1e-12) 0 else d^2 / (d^2 + v) };"
    "every <- function(a, b) { x <- c(a, b); s <- apply(combn(length(x), length(a)), 2, "
    "function(i) welch(x[i], x[-i])); mean(s >= welch(a, b) - 1e-9) };"
    "interval <- function(a, b) as.numeric(t.test(a, b)$conf.int);";

std::string of(const Values& first, const Values& second) {
  return r_vector(first) + ", " + r_vector(second);
}

Values normals(core::Rng& rng, int count, double spread) {
  Values values;
  for (int i = 0; i < count; ++i) {
    values.push_back(spread * rng.normal());
  }
  return values;
}
}  // namespace

TEST_CASE("two groups are contrasted as by R: Welch's interval, p of all assignments",
          "[analysis][groups]") {
  const std::vector<std::pair<Values, Values>> cases{
      {{0.5, 0.75, 1.0, 0.625}, {0.25, 0.5, 0.375, 0.5, 0.125}},
      {{0.5, 0.5, 0.5}, {0.25, 0.75, 0.5, 0.5}},
      {{1.0, 1.0, 1.0}, {0.5, 0.5, 0.75}},
      {{-3.25, 2.5}, {10.0, 11.0, 9.5, 10.25, 30.0}}};
  for (const auto& [first, second] : cases) {
    const auto r = r_numbers(all_assignments + "out(every(" + of(first, second) + "), interval(" +
                             of(first, second) + "))");
    const GroupContrast contrast = group_contrast(first, second, 1);
    CHECK(contrast.test.is_exact);
    CHECK(contrast.test.p == Approx(r[0]).epsilon(1e-12));
    REQUIRE(contrast.interval);
    CHECK(contrast.interval->low == Approx(r[1]).epsilon(1e-10));
    CHECK(contrast.interval->high == Approx(r[2]).epsilon(1e-10));
    CHECK(group_contrast(second, first, 1).test.p == contrast.test.p);
    CHECK(group_contrast(second, first, 1).difference == Approx(-contrast.difference));
  }
}

TEST_CASE("random assignments tell p of all of them", "[analysis][groups]") {
  core::Rng rng{5};
  const Values first = normals(rng, 9, 1.0);
  Values second = normals(rng, 9, 2.0);
  for (double& value : second) {
    value += 1.0;
  }
  const GroupContrast contrast = group_contrast(first, second, 3);
  CHECK_FALSE(contrast.test.is_exact);
  const double p = r_numbers(all_assignments + "out(every(" + of(first, second) + "))").front();
  const double error = std::sqrt(p * (1.0 - p) / 9999.0);
  CHECK(std::abs(contrast.test.p - p) < 4.0 * error + 1e-4);
}

TEST_CASE("groups of one population differ significantly in no more studies than they should",
          "[analysis][groups]") {
  constexpr int studies = 1000;
  for (const auto& [first, second] : {std::pair{5, 5}, {3, 8}, {6, 4}}) {
    int significant = 0;
    for (int study = 0; study < studies; ++study) {
      core::Rng rng{
          core::derived_seed(11, core::Purpose::study, static_cast<std::uint64_t>(study))};
      Values one;
      Values other;
      for (int i = 0; i < first + second; ++i) {  // shares of 12 answers, which are often equal
        int right = 0;
        for (int answer = 0; answer < 12; ++answer) {
          right += rng.uniform() < 0.6 ? 1 : 0;
        }
        (i < first ? one : other).push_back(right / 12.0);
      }
      significant += group_permutation_test(one, other, 1).p <= 0.05 ? 1 : 0;
    }
    INFO(first << " and " << second);
    CHECK(significant <= 50 + 4.0 * std::sqrt(studies * 0.05 * 0.95));
    CHECK(significant >= 15);  // nor is it blind: few assignments and ties make it conservative
  }
}

TEST_CASE("Welch's interval holds the difference of groups whose spreads differ in 95 % of studies",
          "[analysis][groups]") {
  constexpr int studies = 1000;
  int held = 0;
  for (int study = 0; study < studies; ++study) {
    core::Rng rng{core::derived_seed(12, core::Purpose::study, static_cast<std::uint64_t>(study))};
    const auto interval = group_contrast(normals(rng, 4, 3.0), normals(rng, 6, 1.0), 1).interval;
    held += interval->low <= 0.0 && 0.0 <= interval->high ? 1 : 0;
  }
  CHECK(std::abs(held - 950) <= 4.0 * std::sqrt(studies * 0.05 * 0.95));
}

TEST_CASE("scores of known values are R's ranks, and who lies beyond all values is above all",
          "[analysis][groups]") {
  const auto exact = [](const Values& values) {
    std::vector<Interval> ranges;
    for (const double value : values) {
      ranges.push_back({value, value});
    }
    return ranges;
  };
  const Values first{0.5, 2.0, 2.0};
  const Values second{1.0, 0.25, 4.0, 2.0};
  const auto r = r_numbers("x <- c(" + of(first, second) + "); out(2 * rank(x) - length(x) - 1)");
  GroupScores scores = gehan_scores(exact(first), exact(second));
  Values all = scores.first;
  all.insert(all.end(), scores.second.begin(), scores.second.end());
  CHECK(all == r);
  const double infinity = std::numeric_limits<double>::infinity();
  scores = gehan_scores({{4.0, infinity}, {4.0, infinity}}, exact({1.0, 2.0, 4.0}));
  CHECK(scores.first == Values{3.0, 3.0});  // above all whose values are known, and as each other
  CHECK(scores.second == Values{-4.0, -2.0, 0.0});
}

TEST_CASE("groups of fewer than two people are not compared", "[analysis][groups]") {
  CHECK_THROWS_AS(group_contrast({1.0}, {1.0, 2.0}, 1), core::InvalidInput);
  CHECK_THROWS_AS(group_contrast({1.0, 2.0}, {}, 1), core::InvalidInput);
  CHECK_THROWS_AS(group_contrast({1.0, std::nan("")}, {1.0, 2.0}, 1), core::InvalidInput);
  CHECK_FALSE(group_contrast({1.0, 1.0}, {2.0, 2.0}, 1).interval);
  CHECK(group_contrast({1.0, 1.0}, {1.0, 1.0}, 1).test.p == 1.0);
}
