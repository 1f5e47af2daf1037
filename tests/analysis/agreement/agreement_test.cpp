#include "analysis/agreement/independence.hpp"
#include "analysis/agreement/kappa.hpp"
#include "analysis/agreement/symmetry.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/python_program.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

TEST_CASE("kappa, its standard error and its interval are those of statsmodels",
          "[analysis][agreement]") {
  std::string script = "from statsmodels.stats.inter_rater import cohens_kappa\n";
  for (const CountTable& table : ordinary_tables()) {
    script += "k = cohens_kappa(" + python_matrix(table) +
              ")\nout(k.kappa, k.std_kappa, k.kappa_low, k.kappa_upp)\n";
  }
  const auto expected = python_numbers(script);
  std::size_t at = 0;
  for (const CountTable& table : ordinary_tables()) {
    const auto kappa = cohens_kappa(table);
    REQUIRE(kappa);
    CHECK(kappa->kappa == Approx(expected[at]).epsilon(1e-9));
    CHECK(kappa->standard_error == Approx(expected[at + 1]).epsilon(1e-9));
    CHECK(kappa->interval.low == Approx(expected[at + 2]).epsilon(1e-9));
    CHECK(kappa->interval.high == Approx(std::min(1.0, expected[at + 3])).epsilon(1e-9));
    at += 4;
  }
}

TEST_CASE("kappa has no value where all is of one class, and is 0 without agreement",
          "[analysis][agreement]") {
  CHECK_FALSE(cohens_kappa({{5, 0}, {0, 0}}));
  CHECK_FALSE(cohens_kappa({{0, 0}, {0, 0}}));
  CHECK(cohens_kappa(table_of_one_answer())->kappa == 0.0);
  CHECK(cohens_kappa({{4, 0}, {0, 4}})->kappa == 1.0);
  CHECK_THROWS_AS(cohens_kappa({{1, 2, 3}, {4, 5, 6}}), core::InvalidInput);
}

TEST_CASE("symmetry and homogeneity of totals are tested as by statsmodels",
          "[analysis][agreement]") {
  const std::vector<CountTable> tables{
      paper_table(), large_random_table(), {{8, 3}, {2, 5}}, {{3, 1, 2}, {4, 5, 6}, {1, 1, 1}}};
  std::string script = "from statsmodels.stats.contingency_tables import SquareTable\n";
  for (const CountTable& table : tables) {
    script += "t = SquareTable(" + python_matrix(table) +
              ", shift_zeros=False)\ns, h = t.symmetry(), t.homogeneity('stuart_maxwell')\n"
              "out(s.statistic, s.df, s.pvalue, h.statistic, h.df, h.pvalue)\n";
  }
  const auto expected = python_numbers(script);
  std::size_t at = 0;
  for (const CountTable& table : tables) {
    for (const auto& test : {bowker_test(table), stuart_maxwell_test(table)}) {
      REQUIRE(test);
      CHECK(test->chi_squared == Approx(expected[at]).epsilon(1e-9));
      CHECK(test->degrees_of_freedom == expected[at + 1]);
      CHECK(test->p == Approx(expected[at + 2]).margin(1e-15));
      at += 3;
    }
  }
}

TEST_CASE("homogeneity of totals is coin's too", "[analysis][agreement]") {
  const CountTable moderate{{31, 4, 7}, {12, 25, 9}, {3, 8, 40}};  // coin lists every answer
  for (const CountTable& table : {paper_table(), moderate}) {
    const auto coin =
        r_numbers("suppressPackageStartupMessages(library(coin)); t <- mh_test(as.table(" +
                  r_matrix(table) + ")); out(statistic(t), pvalue(t))");
    const auto ours = stuart_maxwell_test(table);
    REQUIRE(ours);
    CHECK(ours->chi_squared == Approx(coin[0]).epsilon(1e-9));
    CHECK(ours->p == Approx(coin[1]).epsilon(1e-9).margin(1e-12));
  }
}

TEST_CASE("pairs that were never confused and classes that never occur change no test of symmetry",
          "[analysis][agreement]") {
  const CountTable table{{8, 3}, {2, 5}};
  const CountTable padded{{8, 0, 3}, {0, 0, 0}, {2, 0, 5}};
  CHECK(bowker_test(padded)->chi_squared == Approx(bowker_test(table)->chi_squared).epsilon(1e-9));
  CHECK(bowker_test(padded)->degrees_of_freedom == 1.0);
  CHECK(stuart_maxwell_test(padded)->chi_squared ==
        Approx(stuart_maxwell_test(table)->chi_squared).epsilon(1e-9));
  CHECK(stuart_maxwell_test(padded)->degrees_of_freedom == 1.0);
  CHECK_FALSE(bowker_test({{3, 0}, {0, 4}}));
  CHECK_FALSE(stuart_maxwell_test({{3, 0}, {0, 4}}));
  CHECK(stuart_maxwell_test(table_with_a_class_never_answered())->degrees_of_freedom == 2.0);
}

TEST_CASE("dependence of answers on stimuli is R's chi-squared test, residuals included",
          "[analysis][agreement]") {
  for (const CountTable& table : ordinary_tables()) {
    const auto r = r_numbers(
        "m <- " + r_matrix(table) +
        "; t <- suppressWarnings(chisq.test(m, correct = FALSE));"
        "out(t$statistic, t$parameter, t$p.value, 2 * sum(ifelse(m > 0, m * log(m / t$expected), "
        "0)), sqrt(t$statistic / sum(m) / (nrow(m) - 1)), t(t$stdres))");
    const auto test = independence(table);
    REQUIRE(test);
    CHECK(test->chi_squared == Approx(r[0]).epsilon(1e-9));
    CHECK(test->degrees_of_freedom == r[1]);
    CHECK(test->asymptotic_p == Approx(r[2]).margin(1e-300));
    CHECK(test->g_squared == Approx(r[3]).epsilon(1e-9));
    CHECK(test->cramers_v == Approx(r[4]).epsilon(1e-9));
    const auto residuals = adjusted_residuals(table);
    for (std::size_t i = 0; i < table.size(); ++i) {
      for (std::size_t j = 0; j < table.size(); ++j) {
        CHECK(residuals[i][j] == Approx(r[5 + i * table.size() + j]).margin(1e-9));
      }
    }
  }
}

TEST_CASE("lines without answers are left out of a test of independence", "[analysis][agreement]") {
  const auto test = independence(table_with_a_class_never_answered());
  REQUIRE(test);
  const auto without = independence({{6, 4}, {5, 5}, {1, 9}});
  CHECK(test->chi_squared == Approx(without->chi_squared).epsilon(1e-9));
  CHECK(test->degrees_of_freedom == 2.0);
  CHECK_FALSE(independence(table_of_one_answer()));
  CHECK(adjusted_residuals(table_of_one_answer())[0][1] == 0.0);
}

TEST_CASE("the Monte-Carlo probability of X^2 is R's", "[analysis][agreement]") {
  const CountTable table{{5, 2, 1}, {2, 4, 2}, {3, 1, 5}};
  const auto r = r_numbers("set.seed(2); out(chisq.test(" + r_matrix(table) +
                           ", simulate.p.value = TRUE, B = 50000)$p.value)");
  const MonteCarloTest test = monte_carlo_independence(shuffled_tables({table}), 20'000, 5);
  CHECK(test.p == Approx(r[0]).margin(6.0 * std::sqrt(r[0] * (1.0 - r[0]) / 15'000)));
  CHECK(monte_carlo_independence(shuffled_tables({table}), 500, 5, 1).p ==
        monte_carlo_independence(shuffled_tables({table}), 500, 5, 3).p);
  CHECK_THROWS_AS(monte_carlo_independence(shuffled_tables({table}), 0, 5), core::InvalidInput);
}
