#include "analysis/detection/one_against_rest.hpp"

#include "analysis/detection/decision_model.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

TEST_CASE("one class is told from the rest by R's quantiles of corrected rates",
          "[analysis][detection]") {
  for (const CountTable& table : ordinary_tables()) {
    const auto r = r_numbers(
        "m <- " + r_matrix(table) +
        "; h <- (diag(m) + .5) / (rowSums(m) + 1); f <- (colSums(m) - diag(m) + .5) / "
        "(sum(m) - rowSums(m) + 1); out(qnorm(h) - qnorm(f), -(qnorm(h) + qnorm(f)) / 2)");
    const auto found = one_against_rest(table);
    for (std::size_t i = 0; i < table.size(); ++i) {
      REQUIRE(found[i]);
      CHECK(found[i]->d_prime == Approx(r[i]).epsilon(1e-9));
      CHECK(found[i]->criterion == Approx(r[table.size() + i]).margin(1e-12));
    }
  }
}

TEST_CASE("a class that was never presented, or alone, has no d'", "[analysis][detection]") {
  const auto found = one_against_rest(table_of_one_answer());
  CHECK_FALSE(found[0]);
  CHECK_FALSE(found[1]);
  CHECK(one_against_rest(table_with_a_class_never_answered())[1]->d_prime > -1.0);
  CHECK_THROWS_AS(one_against_rest({{1, 2, 3}, {4, 5, 6}}), core::InvalidInput);
}

TEST_CASE(
    "four alternatives' equivalent d' of the paper's 43 of 80 is R's integral's, and psyphy's",
    "[analysis][detection]") {
  const auto r = r_numbers(
      "p <- function(d) integrate(function(x) dnorm(x - d) * pnorm(x)^3, -Inf, Inf, rel.tol = "
      "1e-13, subdivisions = 1000)$value; out(uniroot(function(d) p(d) - 43 / 80, c(0, 5), "
      "tol = 1e-15)$root, psyphy::dprime.mAFC(43 / 80, 4))");
  const double d_prime = sensitivity({DecisionModel::forced_choice, 4}, {43, 80}).d_prime;
  CHECK(d_prime == Approx(r[0]).epsilon(1e-9));
  CHECK(d_prime == Approx(r[1]).epsilon(1e-6));  // psyphy searches to a tolerance of its own
}
