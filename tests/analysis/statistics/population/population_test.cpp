#include <fmt/format.h>

#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <limits>

#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/population/planned_contrasts.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

namespace {
const std::vector<Proportion> people{{2, 8}, {5, 8}, {3, 8}, {7, 8}, {4, 7},
                                     {1, 8}, {4, 8}, {6, 6}, {3, 8}, {5, 8}};

// In R: k, how many were right, and t, of how many trials, of each person.
std::string r_counts(const std::vector<Proportion>& of) {
  std::vector<std::int64_t> right;
  std::vector<std::int64_t> trials;
  for (const Proportion& person : of) {
    right.push_back(person.successes);
    trials.push_back(person.trials);
  }
  return "k <- " + r_vector(right) + "; t <- " + r_vector(trials) + "; ";
}
}  // namespace

TEST_CASE("participants' distribution is that of R's beta-binomial likelihood",
          "[analysis][participants]") {
  const auto result = beta_binomial_mean(people);
  REQUIRE(result);
  const std::string likelihood =
      "k <- c(2,5,3,7,4,1,4,6,3,5); n <- c(8,8,8,8,7,8,8,6,8,8);"
      "l <- function(m, r) { v <- 1 / r - 1; sum(lbeta(k + v * m, n - k + v * (1 - m)) - "
      "lbeta(v * m, v * (1 - m))) };"
      "f <- optim(c(0, -2), function(x) -l(plogis(x[1]), plogis(x[2])), control = list(reltol = "
      "1e-15, maxit = 5000));"
      // values tell a maximum's place to seven digits, the score to all
      "s <- function(a, b) c(sum(digamma(k + a) - digamma(a) + digamma(a + b) - digamma(n + a + "
      "b)),"
      "sum(digamma(n - k + b) - digamma(b) + digamma(a + b) - digamma(n + a + b)));"
      "v <- 1 / plogis(f$par[2]) - 1; q <- v * c(plogis(f$par[1]), plogis(-f$par[1]));"
      "for (i in 1:20) { h <- 1e-6 * q; J <- cbind((s(q[1] + h[1], q[2]) - s(q[1] - h[1], q[2])) / "
      "(2 * h[1]), (s(q[1], q[2] + h[2]) - s(q[1], q[2] - h[2])) / (2 * h[2])); q <- q - "
      "solve(J, s(q[1], q[2])) };";
  const auto r = r_numbers(likelihood + "out(q[1] / sum(q), 1 / (1 + sum(q)))");
  CHECK(result->mean == Approx(r[0]).epsilon(1e-9));
  CHECK(result->intraclass_correlation == Approx(r[1]).epsilon(1e-9));
}

TEST_CASE("the interval over participants is where R's score of the mean is that of t",
          "[analysis][participants]") {
  for (const std::vector<Proportion>& of :
       {people, {{1, 6}, {15, 30}, {28, 30}, {30, 30}}, {{11, 16}, {12, 16}, {12, 16}}}) {
    const auto r = r_numbers(
        r_counts(of) +
        "p <- k / t; n <- length(p); b <- mean(p); phi <- max(var(p) / (b * (1 - b)), .05 * "
        "mean(1 / t)); e <- function(m) (b - m)^2 / (phi * m * (1 - m) / n) - qt(.975, n - 1)^2;"
        "out(b, uniroot(e, c(1e-12, b), tol = 1e-14)$root, uniroot(e, c(b, 1 - 1e-12), tol = "
        "1e-14)$root)");
    const auto result = mean_share(of);
    REQUIRE((result && result->interval));
    CHECK(result->mean == Approx(r[0]).epsilon(1e-12));
    CHECK(result->interval->low == Approx(r[1]).epsilon(1e-6));
    CHECK(result->interval->high == Approx(r[2]).epsilon(1e-6));
  }
}

TEST_CASE("near an end the interval is where R's likelihood and the spread say",
          "[analysis][participants]") {
  const std::vector<Proportion> near_end =
      GENERATE(std::vector<Proportion>{{16, 16}, {30, 30}, {14, 16}, {6, 6}, {15, 16}, {16, 16}},
               std::vector<Proportion>{{3, 6}, {25, 30}, {28, 30}, {30, 30}});
  const auto r = r_numbers(
      r_counts(near_end) +
      "p <- k / t; n <- length(p); b <- mean(p); q <- qt(.975, n - 1)^2;"
      "shown <- q * max(var(p) / (b * (1 - b)), .05 * mean(1 / t));"
      "l <- function(m, e) { v <- 1 / e^2 - 1; sum(lbeta(k + v * m, t - k + v * (1 - m)) - "
      "lbeta(v * m, v * (1 - m))) };"
      "phi <- function(m) { e <- optimize(function(e) l(m, e), c(1e-3, .999), maximum = TRUE, tol "
      "= 1e-9)$maximum; mean((1 + (t - 1) * e^2) / t) };"
      "w <- .6 * min(1, max(0, (abs(2 * b - 1) - .5) / .5));"
      "e <- function(m) (b - m)^2 - max(shown, shown^(1 - w) * (n * log(1 + q / (n - 1)) * "
      "phi(m))^w) * m * (1 - m) / n;"
      "out(uniroot(e, c(1e-6, b), tol = 1e-12)$root, uniroot(e, c(b, 1 - 1e-9), tol = "
      "1e-12)$root)");
  const Interval found = *mean_share(near_end)->interval;
  CHECK(found.low == Approx(r[0]).epsilon(1e-4));
  CHECK(found.high == Approx(r[1]).epsilon(1e-4));
  std::vector<Proportion> wrong;
  for (const Proportion& person : near_end) {
    wrong.push_back({person.trials - person.successes, person.trials});
  }
  const Interval turned = *mean_share(wrong)->interval;  // errors are as uncertain as right answers
  CHECK(turned.low == Approx(1.0 - found.high).margin(1e-6));
  CHECK(turned.high == Approx(1.0 - found.low).margin(1e-6));
}

TEST_CASE("the mean over participants and their intra-class correlation are glmmTMB's",
          "[analysis][participants]") {
  std::vector<int> right;
  std::vector<int> wrong;
  for (const Proportion& of : people) {
    right.push_back(static_cast<int>(of.successes));
    wrong.push_back(static_cast<int>(of.trials - of.successes));
  }
  const auto r = r_numbers(
      "suppressPackageStartupMessages(library(glmmTMB)); d <- data.frame(k = " + r_vector(right) +
      ", m = " + r_vector(wrong) +
      "); f <- glmmTMB(cbind(k, m) ~ 1, data = d, family = betabinomial(), control = "
      "glmmTMBControl(optCtrl = list(iter.max = 1e4, eval.max = 1e4, rel.tol = 1e-15, x.tol = "
      "1e-12)));"
      "out(plogis(fixef(f)$cond), 1 / (1 + sigma(f)))");
  const auto result = beta_binomial_mean(people);
  REQUIRE(result);
  CHECK(result->mean == Approx(r[0]).epsilon(1e-8));  // as far as its search goes
  CHECK(result->intraclass_correlation == Approx(r[1]).epsilon(1e-8));
}

TEST_CASE("intervals of participants' mean share are R's by t and SciPy's by bootstrap",
          "[analysis][participants]") {
  const auto result = mean_proportion(people);
  std::string shares;
  for (const Proportion& of : people) {
    shares += fmt::format("{}{:.17g}", shares.empty() ? "" : ",", of.value());
  }
  const auto r = r_numbers("out(t.test(c(" + shares + "))$conf.int)");
  REQUIRE((result->t && result->bootstrap));
  CHECK(result->t->low == Approx(r[0]).epsilon(1e-9));
  CHECK(result->t->high == Approx(r[1]).epsilon(1e-9));
  const auto scipy = python_numbers(
      "from scipy.stats import bootstrap, norm, t\nx = np.array([" + shares +
      "])\nn = len(x)\n"
      "tail = norm.cdf(-np.sqrt(n / (n - 1)) * t.ppf(.975, n - 1))  # Hesterberg 2015\n"
      "r = bootstrap((x,), np.mean, n_resamples=40000, method='BCa', random_state=1,\n"
      "              confidence_level=1 - 2 * tail).confidence_interval\nout(r.low, r.high)\n");
  CHECK(result->bootstrap->low == Approx(scipy[0]).margin(0.012));
  CHECK(result->bootstrap->high == Approx(scipy[1]).margin(0.012));
}

TEST_CASE("a skewed sample moves the bootstrap interval as SciPy's does",
          "[analysis][participants]") {
  const std::vector<double> values{0.1, 0.2, 0.15, 0.1, 0.9, 0.25, 0.3};
  const auto scipy = python_numbers(
      "from scipy.stats import bootstrap\nr = bootstrap((np.array([.1,.2,.15,.1,.9,.25,.3]),), "
      "np.mean, n_resamples=60000, method='BCa', random_state=1).confidence_interval\n"
      "out(r.low, r.high)\n");
  const auto interval = bca_interval(values, 60'000, 1, 0.025);
  REQUIRE(interval);
  CHECK(interval->low == Approx(scipy[0]).margin(0.005));
  CHECK(interval->high == Approx(scipy[1]).margin(0.01));
}

TEST_CASE(
    "of eight values an expanded bootstrap interval holds the mean in 92 % of samples or more",
    "[analysis][participants][slow]") {
  constexpr int samples = 2000;
  core::Rng rng{3};
  int plain = 0;
  int expanded = 0;
  for (int sample = 0; sample < samples; ++sample) {
    std::vector<double> values(8);
    for (double& value : values) {
      value = rng.normal();
    }
    const auto holds = [](const std::optional<Interval>& interval) {
      return interval && interval->low <= 0.0 && 0.0 <= interval->high;
    };
    plain += holds(bca_interval(values, 999, 1, 0.025)) ? 1 : 0;
    expanded += holds(bootstrap_interval(values, 999, 1)) ? 1 : 0;
  }
  fmt::print("  bootstrap of eight: covered {}, expanded {} of {}\n", plain, expanded, samples);
  CHECK(expanded > 0.92 * samples);
  CHECK(plain < expanded - 0.02 * samples);
}

TEST_CASE("fewer than eight values have no bootstrap interval", "[analysis][participants]") {
  CHECK_FALSE(bootstrap_interval({0.1, 0.4, 0.2}, 999, 1));
  CHECK_FALSE(bootstrap_interval({0.1, 0.4, 0.2, 0.6, 0.3, 0.5, 0.7}, 999, 1));
  CHECK(bootstrap_interval({0.1, 0.4, 0.2, 0.6, 0.3, 0.5, 0.7, 0.8}, 999, 1));
}

TEST_CASE("participants who do not differ, or are all right, have an interval too",
          "[analysis][participants]") {
  const auto equal = mean_proportion({{4, 8}, {4, 8}, {4, 8}});
  REQUIRE(equal);
  CHECK_FALSE(equal->t);
  CHECK_FALSE(equal->bootstrap);
  CHECK(equal->intraclass_correlation == 0.0);
  CHECK((equal->interval->low < 0.5 && equal->interval->high > 0.5));
  const auto perfect = mean_proportion({{8, 8}, {8, 8}, {8, 8}, {8, 8}, {0, 0}});
  REQUIRE(perfect);
  CHECK(perfect->participants == 4);
  CHECK(perfect->interval->high == 1.0);
  // Wilson's of 32 answers, with t of three degrees of freedom, takes people for alike
  const double t = r_numbers("out(qt(.975, 3))").front();
  CHECK(perfect->interval->low < 1.0 / (1.0 + t * t / 32.0));
  CHECK(perfect->interval->low > 0.5);
  CHECK_FALSE(mean_proportion({{3, 8}}));
  CHECK_THROWS_AS(mean_proportion({{9, 8}, {1, 8}}), core::InvalidInput);
}

TEST_CASE("two participants have a mean and no interval", "[analysis][participants]") {
  const auto two = mean_share({{2, 8}, {6, 12}, {0, 0}});
  REQUIRE(two);
  CHECK(two->mean == 0.375);
  CHECK_FALSE(two->interval);
}

namespace {
// How often of so many studies the mean of shares is in its interval, and how wide that is as a
// share of that by t.
struct Coverage {
  double held{};
  double width{};
};

std::int64_t trials_of(bool are_equal, core::Rng& rng) {
  return are_equal || rng.uniform() < 0.6 ? (are_equal ? 16 : 30) : 6;  // who stops at 6 of 30
}

double share_of_person(double mean, double intraclass, core::Rng& rng) {
  if (intraclass == 0.0) {
    return mean;
  }
  const double nu = 1.0 / intraclass - 1.0;
  return boost::math::quantile(boost::math::beta_distribution<>{nu * mean, nu * (1.0 - mean)},
                               rng.uniform());
}

Coverage coverage(double mean, double intraclass, int participants, bool are_equal) {
  constexpr int studies = 2000;
  core::Rng rng{23};
  Coverage found;
  double width = 0.0;
  double width_of_t = 0.0;
  for (int study = 0; study < studies; ++study) {
    std::vector<Proportion> drawn;
    std::vector<double> shares;
    for (int i = 0; i < participants; ++i) {
      const double share = share_of_person(mean, intraclass, rng);
      drawn.push_back({0, trials_of(are_equal, rng)});
      for (std::int64_t k = 0; k < drawn.back().trials; ++k) {
        drawn.back().successes += rng.uniform() < share ? 1 : 0;
      }
      shares.push_back(drawn.back().value());
    }
    const Interval of = *mean_share(drawn)->interval;
    const Interval by_t = t_interval(shares);
    found.held += of.low <= mean && mean <= of.high ? 1.0 / studies : 0.0;
    width += of.high - of.low;
    width_of_t += std::min(1.0, by_t.high) - std::max(0.0, by_t.low);
  }
  found.width = width / width_of_t;
  return found;
}
}  // namespace

TEST_CASE("the interval over participants holds their mean in 93 to 97 % of studies",
          "[analysis][participants]") {
  constexpr double tolerance = 0.01;  // two standard errors of 2000 studies
  for (const int participants : {3, 5, 8, 20}) {
    for (const double intraclass : {0.0, 0.1, 0.3}) {
      for (const bool are_equal : {true, false}) {
        const Coverage found = coverage(0.5, intraclass, participants, are_equal);
        INFO(participants << " participants, intra-class correlation " << intraclass << ", "
                          << (are_equal ? "equal" : "unequal") << " trials: " << found.held
                          << ", width " << found.width);
        CHECK(found.held > 0.93 - tolerance);
        CHECK(found.held < 0.97 + tolerance);
        CHECK(found.width < 1.15);
      }
    }
  }
}

TEST_CASE("a share near 1 is held also where those who find it hard stop early",
          "[analysis][participants]") {
  constexpr int studies = 2000;
  constexpr double mean = 0.9;
  core::Rng rng{31};
  int held = 0;
  for (int study = 0; study < studies; ++study) {
    std::vector<Proportion> drawn;
    for (int person = 0; person < 5; ++person) {
      const double share = share_of_person(mean, 0.3, rng);
      drawn.push_back({0, share < mean ? 6 : 30});
      for (std::int64_t k = 0; k < drawn.back().trials; ++k) {
        drawn.back().successes += rng.uniform() < share ? 1 : 0;
      }
    }
    const Interval of = *mean_share(drawn)->interval;
    held += of.low <= mean && mean <= of.high ? 1 : 0;
  }
  CHECK(held > 0.93 * studies);
}

TEST_CASE("a paired contrast is tested by all patterns of signs", "[analysis][participants]") {
  const std::vector<double> differences{0.25, -0.125, 0.5, 0.0, 0.375, 0.125, -0.25, 0.625};
  const auto r = r_numbers("d <- " + r_vector(differences) +
                           "; s <- as.matrix(expand.grid(rep(list(c(-1, 1)), length(d))));"
                           "out(mean(abs(s %*% d) >= abs(sum(d)) - 1e-9), t.test(d)$conf.int)");
  const PairedContrast contrast = paired_contrast(differences, 1);
  CHECK(contrast.is_exact);
  CHECK(contrast.p == Approx(r[0]).epsilon(1e-9));
  CHECK(contrast.interval->low == Approx(r[1]).epsilon(1e-9));
  CHECK(contrast.interval->high == Approx(r[2]).epsilon(1e-9));
  CHECK(contrast.mean == Approx(0.1875).epsilon(1e-9));
}

TEST_CASE("a paired contrast's test is coin's exact test of symmetry", "[analysis][participants]") {
  for (const std::vector<double>& differences :
       {std::vector<double>{0.25, -0.125, 0.5, 0.0, 0.375, 0.125, -0.25, 0.625},
        std::vector<double>{1, 2, 3, 4, 5, -6, 7, 8, 9, 10, -11, 12, 13, 14, -15, 16},
        std::vector<double>{-0.5, -0.5, -0.5, 0.25}}) {
    const auto coin = r_numbers("suppressPackageStartupMessages(library(coin)); d <- " +
                                r_vector(differences) + R"(
n <- length(d); both <- data.frame(y = c(d, 0 * d), condition = gl(2, n), person = gl(n, 1, 2 * n))
out(pvalue(symmetry_test(y ~ condition | person, both, distribution = exact()))))");
    const SignFlipTest ours = sign_flip_test(differences, 1);
    CHECK(ours.is_exact);
    CHECK(ours.p == Approx(coin.front()).epsilon(1e-9));
  }
}

TEST_CASE("a contrast of many participants is drawn, near what all patterns give",
          "[analysis][participants]") {
  std::vector<double> differences;
  for (int i = 1; i <= 20; ++i) {
    differences.push_back(i % 3 == 0 ? -i : 0.7 * i);
  }
  for (double& difference : differences) {
    difference = std::round(difference);
  }
  const auto r = r_numbers("d <- " + r_vector(differences) +
                           "; p <- 1; for (x in abs(d)) { q <- numeric(length(p) + 2 * x); "
                           "q[seq_along(p)] <- p / 2; i <- 2 * x + seq_along(p); q[i] <- q[i] + "
                           "p / 2; p <- q }; v <- seq(-sum(abs(d)), sum(abs(d)));"
                           "out(sum(p[abs(v) >= abs(sum(d))]))");
  const SignFlipTest test = sign_flip_test(differences, 1);
  CHECK_FALSE(test.is_exact);
  CHECK(test.p == Approx(r[0]).margin(5.0 * std::sqrt(r[0] * (1.0 - r[0]) / 9999)));
}

TEST_CASE("one participant and no difference show nothing", "[analysis][participants]") {
  CHECK(sign_flip_test({0.5}, 1).p == 1.0);
  CHECK(sign_flip_test({0.0, 0.0, 0.0}, 1).p == 1.0);
  CHECK_FALSE(paired_contrast({0.5}, 1).interval);
  CHECK_THROWS_AS(sign_flip_test({}, 1), core::InvalidInput);
  CHECK_THROWS_AS(sign_flip_test({std::nan("")}, 1), core::InvalidInput);
}

TEST_CASE("the likelihood of differences that are all exact has the interval of t",
          "[analysis][participants]") {
  const std::vector<double> exact{0.31, -0.12, 0.55, 0.02, 0.78, 0.21};
  std::vector<Interval> ranges;
  for (const double value : exact) {
    ranges.push_back({value, value});
  }
  const PairedContrast found = censored_contrast(ranges, 1);
  const Interval by_t = t_interval(exact);
  CHECK(found.mean == Approx(paired_contrast(exact, 1).mean).epsilon(1e-5));
  CHECK(found.interval->low == Approx(by_t.low).epsilon(1e-4));
  CHECK(found.interval->high == Approx(by_t.high).epsilon(1e-4));
  ranges.front() = {exact.front() - 1e-9, exact.front() + 1e-9};
  const EquivalenceTest by_t_tests = equivalence_test(exact, 0.5);
  const EquivalenceTest by_likelihood = equivalence_test(ranges, 0.5);
  CHECK(by_likelihood.interval_90.high == Approx(by_t_tests.interval_90.high).epsilon(1e-4));
  CHECK(by_likelihood.p_above == Approx(by_t_tests.p_above).epsilon(1e-3));
  CHECK(by_likelihood.p_below == Approx(by_t_tests.p_below).epsilon(1e-3));
}

TEST_CASE("differences of which some are ranges have R's normal likelihood",
          "[analysis][participants]") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Interval> ranges{{0.3, 0.3},      {0.7, 0.7}, {1.1, 1.1},  {0.9, infinity},
                                     {0.5, infinity}, {0.4, 0.4}, {-0.2, 0.8}, {-infinity, 0.6}};
  const auto r = r_numbers(
      "a <- c(.3, .7, 1.1, .9, .5, .4, -.2, -Inf); b <- c(.3, .7, 1.1, Inf, Inf, .4, .8, .6);"
      "l <- function(m, s) -sum(ifelse(a == b, dnorm(a, m, s, log = TRUE), log(pnorm(b, m, s) - "
      "pnorm(a, m, s)))); p <- function(m) optimize(function(x) l(m, exp(x)), c(-5, 5), tol = "
      "1e-10)$objective; o <- optimize(p, c(-2, 3), tol = 1e-10); n <- 8; k <- n * log(1 + "
      "qt(.975, n - 1)^2 / (n - 1)); e <- function(m) 2 * (p(m) - o$objective) - k;"
      "out(o$minimum, uniroot(e, c(-5, o$minimum), tol = 1e-10)$root, uniroot(e, c(o$minimum, 9), "
      "tol = 1e-10)$root)");
  const PairedContrast found = censored_contrast(ranges, 1);
  CHECK(found.mean == Approx(r[0]).epsilon(1e-4));
  CHECK(found.interval->low == Approx(r[1]).epsilon(1e-3));
  CHECK(found.interval->high == Approx(r[2]).epsilon(1e-3));
  CHECK(found.participants == 8);
}

TEST_CASE("of values above 0 the interval ends where R's score with a variance like the mean does",
          "[analysis][participants]") {
  const auto r = r_numbers(
      "x <- c(.4, .9, .5, 3.1, .7); y <- c(.1, .2, 5); u <- function(x) { n <- length(x); m <- "
      "mean(x); uniroot(function(a) (m - a)^2 - qt(.975, n - 1)^2 * var(x) / n * a / m, c(m, 1e3), "
      "tol = 1e-12)$root }; out(t.test(x)$conf.int[1], u(x), u(y))");
  const Interval found = positive_interval({0.4, 0.9, 0.5, 3.1, 0.7});
  CHECK(found.low == std::max(0.0, t_interval({0.4, 0.9, 0.5, 3.1, 0.7}).low));
  CHECK(r[0] < 0.0);
  CHECK(found.high == Approx(r[1]).epsilon(1e-9));
  CHECK(positive_interval({0.1, 0.2, 5.0}).high == Approx(r[2]).epsilon(1e-9));
  CHECK(positive_interval({10.0, 11.0, 12.0}).low == t_interval({10.0, 11.0, 12.0}).low);
  CHECK(positive_interval({-0.1, 0.2, 5.0}).high == t_interval({-0.1, 0.2, 5.0}).high);
  CHECK(positive_interval({0.0, 0.0}).high == 0.0);
  CHECK_THROWS_AS(positive_interval({1.0}), core::InvalidInput);
}

TEST_CASE("the mean of a bounded scale stays within its bounds", "[analysis][participants]") {
  const auto two = bounded_interval({40.0, 87.0}, {0.0, 100.0});
  REQUIRE(two);
  CHECK((two->low > 0.0 && two->low < 40.0));
  CHECK((two->high < 100.0 && two->high > 87.0));
  CHECK_FALSE(bounded_interval({50.0, 50.0}, {0.0, 100.0}));
  CHECK_THROWS_AS(bounded_interval({50.0, 101.0}, {0.0, 100.0}), core::InvalidInput);
}
