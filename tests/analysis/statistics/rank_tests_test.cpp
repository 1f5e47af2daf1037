// Tests of ratings and ranks, against R's friedman.test, wilcox.test, p.adjust and quantile.
#include "analysis/statistics/rank_tests.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "analysis/statistics/distributions.hpp"
#include "analysis/statistics/friedman_test.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using analysis::RatingTable;

namespace {
const RatingTable tied{{3, 5, 5, 7}, {2, 2, 4, 6}, {4, 5, 3, 5}, {1, 3, 3, 3},
                       {5, 6, 6, 7}, {2, 4, 3, 6}, {3, 3, 5, 4}};
const RatingTable untied{{3.1, 5.4, 5.2, 7.9},  {2.0, 2.5, 4.4, 6.6}, {4.7, 5.1, 3.3, 5.9},
                         {1.2, 3.8, 3.5, 3.05}, {5.6, 6.1, 6.8, 7.7}, {2.7, 4.1, 3.2, 6.25},
                         {3.4, 3.0, 5.5, 4.65}};

// m, by rows.
std::string r_table(const RatingTable& ratings) {
  std::vector<double> values;
  for (const auto& row : ratings) {
    values.insert(values.end(), row.begin(), row.end());
  }
  return "m <- matrix(" + testing::r_vector(values) +
         fmt::format(", ncol = {}, byrow = TRUE)\n", ratings.front().size());
}
}  // namespace

TEST_CASE("Friedman's statistic and mean ranks are R's", "[analysis][rank_tests]") {
  for (const RatingTable& ratings : {tied, untied}) {
    const std::vector<double> expected = testing::r_numbers(r_table(ratings) + R"(
f <- friedman.test(m); out(f$statistic, f$parameter)
out(colMeans(t(apply(m, 1, rank))))
)");
    REQUIRE(expected.size() == 2 + 4);
    const auto ours = analysis::friedman_test(ratings, 1);
    CHECK(ours.chi_squared == Approx(expected[0]).epsilon(1e-12));
    CHECK(ours.degrees_of_freedom == expected[1]);
    for (std::size_t j = 0; j < 4; ++j) {
      CHECK(ours.mean_ranks[j] == Approx(expected[2 + j]).epsilon(1e-12));
    }
  }
}

namespace {
// Of all orders of all participants' ranks, one by one.
double share_of_orders(const RatingTable& ratings) {
  const double observed = analysis::friedman_test(ratings, 1).chi_squared;
  int orders = 0;
  int as_large = 0;
  const std::function<void(RatingTable&, std::size_t)> visit = [&](RatingTable& table,
                                                                   std::size_t person) {
    if (person == table.size()) {
      ++orders;
      as_large += analysis::friedman_test(table, 1).chi_squared >= observed - 1e-9 ? 1 : 0;
      return;
    }
    const std::vector<double> own = table[person];
    std::vector<std::size_t> places(own.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    do {
      for (std::size_t i = 0; i < own.size(); ++i) {
        table[person][i] = own[places[i]];
      }
      visit(table, person + 1);
    } while (std::ranges::next_permutation(places).found);
    table[person] = own;
  };
  RatingTable table = ratings;
  visit(table, 0);
  return static_cast<double>(as_large) / orders;
}
}  // namespace

TEST_CASE("Friedman's p is the share of orders of ranks that differ as much, ties as they are",
          "[analysis][rank_tests]") {
  const std::vector<RatingTable> tables{{{1, 2, 3}, {1, 3, 2}, {2, 1, 3}},
                                        {{1, 1, 3}, {1, 3, 2}, {2, 2, 2}, {1, 2, 2}},
                                        {{1, 2, 3, 4}, {2, 2, 3, 4}, {1, 4, 3, 3}}};
  for (const RatingTable& table : tables) {
    const auto ours = analysis::friedman_test(table, 1);
    CHECK(ours.is_exact);
    CHECK(ours.p == Approx(share_of_orders(table)).epsilon(1e-12));
  }
}

TEST_CASE("Friedman's p is that of the published tables of its exact distribution",
          "[analysis][rank_tests]") {
  // Friedman 1937, tables V and VI: probability of a statistic at least as large
  const auto p_of = [](const RatingTable& table) { return analysis::friedman_test(table, 1).p; };
  const std::vector<double> up{1, 2, 3};
  CHECK(p_of({up, up, up}) == Approx(0.028).margin(5e-4));                  // 6.000
  CHECK(p_of({up, up, {1, 3, 2}}) == Approx(0.194).margin(5e-4));           // 4.667
  CHECK(p_of({up, up, up, {1, 3, 2}}) == Approx(0.042).margin(5e-4));       // 6.500
  CHECK(p_of({{1, 2, 3, 4}, {1, 2, 3, 4}}) == Approx(0.042).margin(5e-4));  // 6.000
}

TEST_CASE("where orders are too many Friedman's p is of random ones, and chi-squared's in the end",
          "[analysis][rank_tests]") {
  core::Rng rng{4};
  RatingTable table;
  for (int person = 0; person < 60; ++person) {
    table.emplace_back();
    for (int condition = 0; condition < 8; ++condition) {
      table.back().push_back(rng.normal() + 0.05 * condition);
    }
  }
  const auto ours = analysis::friedman_test(table, 1);
  CHECK_FALSE(ours.is_exact);
  const double limit = analysis::chi_squared_p(ours.chi_squared, ours.degrees_of_freedom);
  CHECK(ours.p == Approx(limit).margin(4.0 * std::sqrt(limit * (1.0 - limit) / 9999.0) + 0.005));
}

TEST_CASE("Kendall's W is 1 of judges who agree and the squared deviations of rank sums else",
          "[analysis][rank_tests]") {
  CHECK(analysis::friedman_test({{1, 2, 3}, {4, 6, 9}, {1, 5, 8}}, 1).kendalls_w ==
        Approx(1.0).epsilon(1e-12));
  CHECK(analysis::friedman_test({{1, 2, 3}, {3, 2, 1}}, 1).kendalls_w == Approx(0.0).margin(1e-12));
  // W = 12 S / (m^2 (n^3 - n)), Kendall & Babington Smith 1939: rank sums 4, 6, 8 of 3 judges
  CHECK(analysis::friedman_test({{1, 2, 3}, {1, 3, 2}, {2, 1, 3}}, 1).kendalls_w ==
        Approx(12.0 * 8.0 / (9.0 * 24.0)).epsilon(1e-12));
}

TEST_CASE("equal values share the mean of their ranks", "[analysis][rank_tests]") {
  CHECK(analysis::mid_ranks({5, 1, 5, 9}) == std::vector<double>{2.5, 1.0, 2.5, 4.0});
}

TEST_CASE("signed rank tests of pairs and Holm's adjustment are coin's and R's",
          "[analysis][rank_tests]") {
  for (const RatingTable& ratings : {tied, untied}) {
    const std::vector<double> expected =
        testing::r_numbers(testing::exact_signed_rank_p + r_table(ratings) + R"(
p <- c()
for (i in 1:3) for (j in (i + 1):4) {
  d <- round(m[, i] - m[, j], 9)  # else ties are broken by rounding
  w <- suppressWarnings(wilcox.test(d))
  out(w$statistic); p <- c(p, exact_signed_rank_p(d))
}
out(p, p.adjust(p, 'holm'))
)");
    REQUIRE(expected.size() == 18);
    const auto ours = analysis::pairwise_signed_rank(ratings);
    REQUIRE(ours.size() == 6);
    for (std::size_t pair = 0; pair < 6; ++pair) {
      INFO(ours[pair].first << " and " << ours[pair].second);
      CHECK(ours[pair].test.positive_ranks == expected[pair]);
      CHECK(ours[pair].test.p == Approx(expected[6 + pair]).epsilon(1e-10));
      CHECK(ours[pair].adjusted_p == Approx(expected[12 + pair]).epsilon(1e-10));
    }
    CHECK(ours.front().first == 0);
    CHECK(ours.back().second == 3);
  }
}

TEST_CASE(
    "from fifty differences on the signed rank test is R's normal one, below it R's exact one, and "
    "with ties and zeros coin's",
    "[analysis][rank_tests]") {
  core::Rng rng{4};
  std::vector<double> many(60);
  for (double& one : many) {
    one = rng.normal() + 0.2;
  }
  const std::vector<double> coarse{1, -2, 0, 3, 3, -1, 2, 4, 0, 5, -3};
  const std::vector<double> below(many.begin(), many.begin() + 49);
  const std::vector<double> with_zero{1.5, -2.5, 0.0, 3.5, 4.5, -0.5, 5.5};
  const std::vector<double> alike(5, 1.0);
  for (const auto& differences : {many, coarse, with_zero, below, alike}) {
    const bool has_ties = differences.size() < 49;
    const std::vector<double> expected = testing::r_numbers(
        "suppressPackageStartupMessages(library(coin)); d <- " + testing::r_vector(differences) +
        "; w <- suppressWarnings(wilcox.test(d)); out(w$statistic, " +
        (has_ties ? "pvalue(wilcoxsign_test(d ~ rep(0, length(d)), zero.method = 'Wilcoxon', "
                    "distribution = exact())))"
                  : "w$p.value)"));
    const auto ours = analysis::signed_rank_test(differences);
    CHECK(ours.positive_ranks == expected.at(0));
    CHECK(ours.p.value() == Approx(expected.at(1)).epsilon(1e-9));
    CHECK(ours.is_exact == (differences.size() < 50));
  }
  CHECK(analysis::signed_rank_test(coarse).pairs == 9);
  CHECK_FALSE(analysis::signed_rank_test({0.0, 0.0}).p);
}

TEST_CASE("marks a hundredth apart are tied as their hundredths are, though not in binary",
          "[analysis][rank_tests]") {
  const std::vector<std::pair<int, int>> hundredths{{40, 15}, {45, 35}, {60, 70}, {30, 30},
                                                    {55, 60}, {55, 65}, {60, 70}, {55, 50},
                                                    {40, 40}, {45, 35}};
  std::vector<double> of_marks;
  std::vector<double> of_hundredths;
  for (const auto& [one, other] : hundredths) {
    of_marks.push_back(one / 100.0 - other / 100.0);
    of_hundredths.push_back(one - other);
  }
  const auto marks = analysis::signed_rank_test(of_marks);
  const auto whole = analysis::signed_rank_test(of_hundredths);
  CHECK(marks.positive_ranks == whole.positive_ranks);
  CHECK(marks.pairs == 8);
  CHECK(marks.p == whole.p);
}

TEST_CASE("values that are equal are their mean and do not deviate", "[analysis][rank_tests]") {
  for (const double value : {0.1, 0.3, 0.7, 1.1, 66.7, -1e-5}) {
    for (std::size_t count = 2; count < 40; ++count) {
      const auto found = analysis::mean_and_spread(std::vector<double>(count, value));
      CAPTURE(value, count);
      CHECK(found.mean == value);
      CHECK(found.standard_deviation == 0.0);
    }
  }
}

TEST_CASE("ratings that cannot be compared are refused", "[analysis][rank_tests]") {
  CHECK_THROWS_AS(analysis::friedman_test({}, 1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::friedman_test({{1, 2}}, 1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::friedman_test({{1}, {2}}, 1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::friedman_test({{1, 2}, {2}}, 1), core::InvalidInput);
  CHECK_THROWS_AS(analysis::friedman_test({{1, 2}, {2, std::nan("")}}, 1), core::InvalidInput);
  CHECK_THROWS_WITH(analysis::friedman_test({{1, 1}, {2, 2}}, 1), Contains("the same"));
  CHECK_THROWS_AS(analysis::signed_rank_test({}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::signed_rank_test({1.0, std::numeric_limits<double>::infinity()}),
                  core::InvalidInput);
  CHECK_THROWS_AS(analysis::holm_adjusted({0.5, 1.5}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::quantile({}, 0.5), core::InvalidInput);
  CHECK_THROWS_AS(analysis::quantile({1.0}, 1.5), core::InvalidInput);
}
