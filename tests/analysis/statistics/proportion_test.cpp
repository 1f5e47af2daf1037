#include "analysis/statistics/proportion.hpp"

#include "analysis/blocks/wording.hpp"
#include "analysis/statistics/permutation_test.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;

namespace {
// Sums the outcomes no more probable than the one observed.
const std::string r_multinomial =
    "f <- function(...) { o <- c(...); n <- sum(o); k <- length(o); e <- rep(1 / k, k);"
    "g <- as.matrix(expand.grid(rep(list(0:n), k - 1))); g <- g[rowSums(g) <= n, , drop = FALSE];"
    "p <- apply(cbind(g, n - rowSums(g)), 1, dmultinom, prob = e);"
    "sum(p[p <= dmultinom(o, prob = e) * (1 + 1e-9)]) };";

// of_r: a test of o[1] successes in o[2] trials that has a conf.int.
void check_intervals(Interval (*interval_of)(const Proportion&), const std::string& of_r) {
  const std::vector<Proportion> proportions{{5, 8}, {0, 10}, {10, 10}, {43, 80}, {1, 1}};
  const auto r =
      r_numbers("for (o in list(c(5, 8), c(0, 10), c(10, 10), c(43, 80), c(1, 1))) out(" + of_r +
                "$conf.int)");
  REQUIRE(r.size() == 2 * proportions.size());
  for (std::size_t i = 0; i < proportions.size(); ++i) {
    CAPTURE(proportions[i].successes, proportions[i].trials);
    const Interval interval = interval_of(proportions[i]);
    CHECK(interval.low == Approx(r[2 * i]).epsilon(1e-9).margin(1e-15));
    CHECK(interval.high == Approx(r[2 * i + 1]).epsilon(1e-9));
  }
}
}  // namespace

TEST_CASE("the Wilson interval is that of R's prop.test without a correction", "[analysis]") {
  check_intervals(wilson_interval, "suppressWarnings(prop.test(o[1], o[2], correct = FALSE))");
}

TEST_CASE("the Wilson interval solves its own equation", "[analysis]") {
  // (p - p0)² = z² p0 (1 - p0) / n at both ends
  const Proportion observed{43, 80};
  const Interval interval = wilson_interval(observed);
  for (const double end : {interval.low, interval.high}) {
    const double z2 = std::pow(observed.value() - end, 2) * 80.0 / (end * (1.0 - end));
    CHECK(std::sqrt(z2) == Approx(1.959963984540054).epsilon(1e-9));
  }
}

TEST_CASE("the exact interval is that of R's binom.test", "[analysis]") {
  check_intervals(exact_interval, "binom.test(o[1], o[2])");
}

TEST_CASE("so many right answers are needed against chance, as by R's binom.test", "[analysis]") {
  const auto r = r_numbers(
      "t <- function(k, n, p) binom.test(k, n, p, 'greater')$p.value;"
      "out(t(5, 8, .25), t(27, 80, .25), t(7, 10, 1 / 3), t(43, 80, .25))");
  CHECK(binomial_p_at_least({5, 8}, 0.25) == Approx(r[0]).epsilon(1e-9));
  CHECK(binomial_p_at_least({27, 80}, 0.25) == Approx(r[1]).epsilon(1e-9));
  CHECK(binomial_p_at_least({7, 10}, 1.0 / 3.0) == Approx(r[2]).epsilon(1e-9));
  CHECK(binomial_p_at_least({43, 80}, 0.25) == Approx(r[3]).epsilon(1e-9));
  CHECK(critical_successes(8, 0.25, 0.05) == 5);
  CHECK(critical_successes(80, 0.25, 0.05) == 27);
  CHECK(binomial_p_at_least({0, 10}, 0.25) == 1.0);
  CHECK(critical_successes(1, 0.25, 0.05) == 2);
  CHECK(binomial_power(1, 0.25, 0.05, 0.9) == 0.0);
}

TEST_CASE("the exact multinomial test orders outcomes by probability", "[analysis]") {
  const std::vector<std::vector<int>> outcomes{{8, 1, 1}, {7, 3, 0},  {7, 2, 1},
                                               {6, 4, 0}, {12, 5, 3}, {1, 1, 1}};
  std::string script = r_multinomial;
  for (const std::vector<int>& counts : outcomes) {
    script += fmt::format("out(f({}));", fmt::join(counts, ","));
  }
  const auto r = r_numbers(script);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    CHECK(exact_multinomial_p(outcomes[i]).value() == Approx(r[i]).epsilon(1e-9));
  }
  CHECK(exact_multinomial_p({4, 0, 0}).value() == Approx(3.0 / 81.0).epsilon(1e-12));  // all alike
  CHECK_FALSE(exact_multinomial_p({400, 0, 0, 0, 0, 0, 0, 0}).has_value());  // too many outcomes
}

TEST_CASE("p values are said as they are printed in papers", "[analysis][report]") {
  CHECK(p_value(0.0201) == "p = .020");
  CHECK(p_value(0.00001) == "p < .001");
  CHECK(p_value(1.0) == "p = 1.000");
  CHECK(p_value(0.99996) == "p = 1.000");
}
