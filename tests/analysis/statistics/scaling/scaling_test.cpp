// Scales from paired comparisons, against the R packages BradleyTerry2 and stats.
#include <cmath>
#include <vector>

#include "analysis/statistics/scaling/power_law.hpp"
#include "analysis/statistics/scaling/preference_scales.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using analysis::PairedCounts;

namespace {
const Eigen::MatrixXi no_ties;

PairedCounts counts_of(const Eigen::MatrixXi& wins, const Eigen::MatrixXi& ties = no_ties) {
  PairedCounts counts;
  counts.wins = wins;
  counts.ties = ties;
  return counts;
}

Eigen::MatrixXi square(const std::vector<int>& rows) {
  const auto items = static_cast<Eigen::Index>(std::lround(std::sqrt(rows.size())));
  return Eigen::Map<const Eigen::MatrixXi>{rows.data(), items, items}.transpose();
}

// items 3 and 4 were never compared
const PairedCounts without_ties =
    counts_of(square({0, 7, 9, 14, 5, 0, 8, 11, 3, 4, 0, 0, 2, 1, 0, 0}));
const PairedCounts with_ties =
    counts_of(without_ties.wins, square({0, 3, 1, 0, 3, 0, 4, 2, 1, 4, 0, 5, 0, 2, 5, 0}));

// Rows i < j of R: the items from 1, preferences for each, ties.
std::string r_pairs(const PairedCounts& counts) {
  std::vector<Eigen::Index> i;
  std::vector<Eigen::Index> j;
  std::vector<int> wins;
  std::vector<int> losses;
  std::vector<int> ties;
  for (Eigen::Index a = 0; a < counts.items(); ++a) {
    for (Eigen::Index b = a + 1; b < counts.items(); ++b) {
      i.push_back(a + 1);
      j.push_back(b + 1);
      wins.push_back(counts.wins(a, b));
      losses.push_back(counts.wins(b, a));
      ties.push_back(counts.ties_of(a, b));
    }
  }
  using testing::r_vector;
  return "i <- " + r_vector(i) + "; j <- " + r_vector(j) + "; w <- " + r_vector(wins) + "; l <- " +
         r_vector(losses) + "; t <- " + r_vector(ties) + "; m <- max(j); N <- length(i)\n" +
         "X <- matrix(0, N, m); X[cbind(1:N, i)] <- 1; Y <- matrix(0, N, m); Y[cbind(1:N, j)] <- "
         "1\n";
}

// Differences from the first item and their standard errors, in the order that R printed them.
void check_differences(const analysis::PreferenceScale& scale, const std::vector<double>& expected,
                       double accuracy) {
  const Eigen::Index others = scale.values.size() - 1;
  for (Eigen::Index other = 1; other <= others; ++other) {
    INFO("item " << other + 1);
    const auto ours = analysis::difference(scale, other, 0);
    const auto place = static_cast<std::size_t>(other - 1);
    const double error = expected.at(place + static_cast<std::size_t>(others));
    CHECK(ours.value == Approx(expected.at(place)).epsilon(accuracy));
    CHECK(ours.standard_error == Approx(error).epsilon(accuracy));
    CHECK(ours.interval.high == Approx(ours.value + 1.959963984540054 * error).epsilon(accuracy));
  }
}
}  // namespace

TEST_CASE("a Bradley-Terry scale is that of BradleyTerry2", "[analysis][paired]") {
  const std::vector<double> expected = testing::r_numbers(r_pairs(without_ties) + R"(
suppressMessages(library(BradleyTerry2))
d <- data.frame(w, l); levels <- paste0('item', 1:m)
d$one <- data.frame(id = factor(levels[i], levels)); d$two <- data.frame(id = factor(levels[j], levels))
d <- d[w + l > 0, ]
b <- BTm(cbind(w, l), one, two, ~ id, id = 'id', data = d, epsilon = 1e-15, maxit = 200)
out(coef(b), sqrt(diag(vcov(b))), summary(b)$coefficients[, 4])
)");
  REQUIRE(expected.size() == 9);
  const auto ours = analysis::bradley_terry({without_ties});
  CHECK(ours.nu == 0.0);
  check_differences(ours.scale, expected, 1e-9);
  for (Eigen::Index other = 1; other < 4; ++other) {
    CHECK(analysis::difference(ours.scale, other, 0).p ==
          Approx(expected[5 + static_cast<std::size_t>(other)]).epsilon(1e-9));
  }
  CHECK(ours.scale.values.sum() == Approx(0.0).margin(1e-12));
  CHECK(ours.scale.covariance.rowwise().sum().cwiseAbs().maxCoeff() < 1e-12);
  for (std::size_t item = 0; item < 4; ++item) {
    const auto place = static_cast<Eigen::Index>(item);
    CHECK(ours.scale.intervals[item].high - ours.scale.values[place] ==
          Approx(1.959963984540054 * std::sqrt(ours.scale.covariance(place, place))).epsilon(1e-9));
  }
}

TEST_CASE("ties after Davidson are a log-linear model of R", "[analysis][paired]") {
  // Fienberg & Larntz 1976: Poisson counts with a constant for each pair
  const std::vector<double> expected = testing::r_numbers(r_pairs(with_ties) + R"(
counts <- c(w, l, t); pair <- factor(rep(1:N, 3)); V <- rbind(X, Y, (X + Y) / 2)[, -1]
tied <- rep(c(0, 0, 1), each = N)
g <- glm(counts ~ 0 + pair + V + tied, family = poisson, control = glm.control(epsilon = 1e-14))
g <- update(g, start = coef(g))  # covariances have the weights of the step before the last
of <- N + 1:(m - 1)
out(coef(g)[of], sqrt(diag(vcov(g)))[of], exp(coef(g)[['tied']]))
)");
  REQUIRE(expected.size() == 7);
  const auto ours = analysis::bradley_terry({with_ties});
  check_differences(ours.scale, expected, 1e-9);
  CHECK(ours.nu == Approx(expected[6]).epsilon(1e-9));
}

TEST_CASE("a scale after Thurstone's Case V is R's probit model, ties as halves",
          "[analysis][paired]") {
  const std::vector<double> expected = testing::r_numbers(r_pairs(with_ties) + R"(
g <- suppressWarnings(glm(cbind(w + t / 2, l + t / 2) ~ 0 + (X - Y)[, -1],
                          family = binomial('probit'), control = glm.control(epsilon = 1e-14)))
# its covariances have the weights of the step before the last
g <- suppressWarnings(update(g, start = coef(g)))
out(coef(g), sqrt(diag(vcov(g))))
)");
  REQUIRE(expected.size() == 6);
  check_differences(analysis::thurstone_case_v({with_ties}), expected, 1e-9);
}

TEST_CASE("two items are as far apart as the logit or probit of their preferences",
          "[analysis][paired]") {
  const PairedCounts counts = counts_of(square({0, 30, 10, 0}));
  const auto logit = analysis::difference(analysis::bradley_terry({counts}).scale, 0, 1);
  CHECK(logit.value == Approx(std::log(3.0)).epsilon(1e-10));
  CHECK(logit.standard_error == Approx(std::sqrt(1.0 / 30.0 + 1.0 / 10.0)).epsilon(1e-10));
  CHECK(analysis::difference(analysis::thurstone_case_v({counts}), 0, 1).value ==
        Approx(0.674489750).epsilon(1e-9));
}

TEST_CASE("items that comparisons do not connect are refused by their places",
          "[analysis][paired]") {
  PairedCounts counts{square({0, 3, 2, 2, 1, 0, 2, 0, 0, 0, 0, 3, 0, 0, 1, 0}),
                      Eigen::MatrixXi::Zero(4, 4)};
  const auto refusal = Contains("of items 3, 4, none was ever preferred to any of items 1, 2");
  CHECK_THROWS_WITH(analysis::bradley_terry({counts}), refusal);
  CHECK_THROWS_WITH(analysis::thurstone_case_v({counts}), refusal);
  const PairedCounts reversed = counts_of(counts.wins.reverse());
  CHECK_THROWS_WITH(analysis::bradley_terry({reversed}),
                    Contains("of items 1, 2, none was ever preferred to any of items 3, 4"));
  counts.ties(1, 3) = counts.ties(3, 1) = 1;  // half a preference of 4 to 2
  CHECK_THROWS_WITH(analysis::bradley_terry({counts}), refusal);
  CHECK_NOTHROW(analysis::thurstone_case_v({counts}));
}

TEST_CASE("paired counts of other shapes and pairs of one item are refused", "[analysis][paired]") {
  const auto refuses = [](const Eigen::MatrixXi& wins, const Eigen::MatrixXi& ties) {
    CHECK_THROWS_AS(analysis::bradley_terry({counts_of(wins, ties)}), core::InvalidInput);
    CHECK_THROWS_AS(analysis::thurstone_case_v({counts_of(wins, ties)}), core::InvalidInput);
  };
  const Eigen::MatrixXi fine = square({0, 3, 2, 0});
  refuses(Eigen::MatrixXi::Zero(1, 1), no_ties);
  refuses(Eigen::MatrixXi::Ones(2, 3), no_ties);
  refuses(Eigen::MatrixXi::Ones(2, 2), no_ties);
  refuses(-fine, no_ties);
  refuses(fine, square({0, 3, 2, 0}));
  refuses(fine, Eigen::MatrixXi::Zero(3, 3));
  const auto scale = analysis::bradley_terry({counts_of(fine)}).scale;
  CHECK_THROWS_AS(analysis::difference(scale, 0, 0), core::InvalidInput);
  CHECK_THROWS_AS(analysis::difference(scale, 0, 2), core::InvalidInput);
}

// Circular triads, counted one by one.
namespace {
Eigen::MatrixXi random_preferences(Eigen::Index items, core::Rng& rng) {
  Eigen::MatrixXi preferred = Eigen::MatrixXi::Zero(items, items);
  for (Eigen::Index i = 0; i < items; ++i) {
    for (Eigen::Index j = i + 1; j < items; ++j) {
      (rng.below(2) == 0 ? preferred(i, j) : preferred(j, i)) = 1;
    }
  }
  return preferred;
}

// A triad is circular if each of its items is preferred to exactly one of the others.
std::int64_t counted(const Eigen::MatrixXi& preferred) {
  std::int64_t circular = 0;
  for (Eigen::Index i = 0; i < preferred.rows(); ++i) {
    for (Eigen::Index j = i + 1; j < preferred.rows(); ++j) {
      for (Eigen::Index k = j + 1; k < preferred.rows(); ++k) {
        const bool is_one_way =
            preferred(i, j) == preferred(j, k) && preferred(j, k) == preferred(k, i);
        circular += is_one_way ? 1 : 0;
      }
    }
  }
  return circular;
}
}  // namespace

TEST_CASE("circular triads are as many as are counted one by one, and zeta is in [0, 1]",
          "[analysis][paired]") {
  core::Rng rng{9};
  for (const Eigen::Index items : {3, 4, 5, 6, 9}) {
    for (int judge = 0; judge < 20; ++judge) {
      const Eigen::MatrixXi preferred = random_preferences(items, rng);
      const auto ours = analysis::consistency(preferred);
      CHECK(ours.circular_triads == counted(preferred));
      CHECK(ours.zeta >= 0.0);
      CHECK(ours.zeta <= 1.0);
    }
  }
}

TEST_CASE("a judge who orders the items has zeta 1, one who turns in circles 0",
          "[analysis][paired]") {
  for (const Eigen::Index items : {3, 4, 5, 6, 7, 8}) {
    Eigen::MatrixXi ordered = Eigen::MatrixXi::Zero(items, items);
    Eigen::MatrixXi circular = Eigen::MatrixXi::Zero(items, items);
    for (Eigen::Index i = 0; i < items; ++i) {
      for (Eigen::Index step = 1; step < items; ++step) {
        ordered(i, (i + step) % items) = (i + step) < items ? 1 : 0;
        // to the items of the half circle after it; across an even one, from its first half
        const bool is_after = 2 * step < items || (2 * step == items && i < items / 2);
        circular(i, (i + step) % items) = is_after ? 1 : 0;
      }
    }
    CHECK(analysis::consistency(ordered).zeta == 1.0);
    CHECK(analysis::consistency(circular).zeta == 0.0);
    CHECK(analysis::consistency(circular).circular_triads == counted(circular));
  }
}

TEST_CASE("preferences that do not name one of each pair are refused", "[analysis][paired]") {
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Zero(3, 3)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Ones(3, 3)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency(Eigen::MatrixXi::Zero(3, 2)), core::InvalidInput);
  CHECK_THROWS_AS(analysis::consistency((Eigen::MatrixXi(2, 2) << 0, 1, 0, 0).finished()),
                  core::InvalidInput);
  CHECK_THROWS_AS(
      analysis::consistency((Eigen::MatrixXi(3, 3) << 0, 2, 1, -1, 0, 1, 0, 0, 0).finished()),
      core::InvalidInput);
}

// Stevens' power law from magnitude estimates, against R's lm and t.test.
using analysis::Estimates;

namespace {
const std::vector<double> values{1.0, 2.0, 4.0, 8.0, 16.0};

Estimates estimates(double modulus, double exponent, const std::vector<double>& deviations) {
  Estimates result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    result.push_back({values[i], modulus * std::pow(values[i], exponent) * deviations[i]});
  }
  return result;
}
}  // namespace

TEST_CASE("a participant's modulus does not change the exponent", "[analysis][magnitudes]") {
  const std::vector<double> exact(5, 1.0);
  const auto law = analysis::power_law({estimates(1.0, 0.8, exact), estimates(100.0, 0.8, exact)});
  CHECK(law.exponent == Approx(0.8).epsilon(1e-12));
  CHECK(*law.r_squared == Approx(1.0).epsilon(1e-12));
  CHECK(law.log_constant == Approx(1.0).epsilon(1e-12));  // the geometric mean of 1 and 100 is 10
  CHECK(law.exponent_interval->low == Approx(0.8).epsilon(1e-9));
  CHECK(law.exponent_interval->high == Approx(0.8).epsilon(1e-9));
  CHECK(law.means.front().geometric_mean == Approx(10.0).epsilon(1e-12));
}

TEST_CASE(
    "an exponent is R's regression of log geometric means, its interval a t test of "
    "participants' exponents",
    "[analysis][magnitudes]") {
  const std::vector<Estimates> participants{estimates(10.0, 0.7, {1.1, 0.9, 1.2, 1.0, 0.8}),
                                            estimates(3.0, 0.9, {0.7, 1.0, 1.1, 1.3, 1.0}),
                                            estimates(40.0, 0.6, {1.0, 1.2, 0.8, 1.1, 1.0}),
                                            estimates(9.0, 0.8, {1.3, 1.0, 1.0, 0.9, 1.1})};
  std::vector<double> all;
  for (const Estimates& one : participants) {
    for (const auto& estimate : one) {
      all.push_back(estimate.estimate);
    }
  }
  const std::vector<double> expected =
      testing::r_numbers("x <- log10(" + testing::r_vector(values) + "); y <- matrix(log10(" +
                         testing::r_vector(all) + R"(), nrow = 5)
g <- lm(rowMeans(y) ~ x); b <- apply(y, 2, function(one) coef(lm(one ~ x))[[2]])
out(coef(g)[[2]], coef(g)[[1]], summary(g)$r.squared, t.test(b)$conf.int, b)
out(10^rowMeans(y), apply(sweep(y, 2, colMeans(y)), 1, sd))
)");
  const auto law = analysis::power_law(participants);
  REQUIRE(expected.size() == 19);
  CHECK(law.exponent == Approx(expected[0]).epsilon(1e-10));
  CHECK(law.log_constant == Approx(expected[1]).epsilon(1e-10));
  CHECK(*law.r_squared == Approx(expected[2]).epsilon(1e-10));
  CHECK(law.exponent_interval->low == Approx(expected[3]).epsilon(1e-10));
  CHECK(law.exponent_interval->high == Approx(expected[4]).epsilon(1e-10));
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(law.participant_exponents[i] == Approx(expected[5 + i]).epsilon(1e-10));
  }
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(law.means[i].value == Approx(values[i]).epsilon(1e-12));
    CHECK(law.means[i].geometric_mean == Approx(expected[9 + i]).epsilon(1e-10));
    CHECK(law.means[i].log_standard_deviation == Approx(expected[14 + i]).epsilon(1e-10));
  }
}

TEST_CASE("repeated estimates of a value count as their geometric mean", "[analysis][magnitudes]") {
  const Estimates once{{1.0, 2.0}, {10.0, 6.0}};
  const Estimates repeated{{1.0, 1.0}, {10.0, 6.0}, {1.0, 4.0}};
  const auto law = analysis::power_law({once, repeated});
  CHECK(law.participant_exponents[0] == Approx(std::log10(3.0)).epsilon(1e-12));
  CHECK(law.participant_exponents[1] == Approx(std::log10(3.0)).epsilon(1e-12));
}

TEST_CASE("magnitudes without a logarithm or a slope are refused", "[analysis][magnitudes]") {
  const Estimates fine{{1.0, 2.0}, {10.0, 6.0}};
  CHECK_THROWS_AS(analysis::power_law({}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::power_law({fine, {{1.0, 2.0}}}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::power_law({fine, {{1.0, 2.0}, {2.0, 0.0}}}), core::InvalidInput);
  CHECK_THROWS_WITH(analysis::power_law({fine, {{1.0, 2.0}, {20.0, 5.0}}}),
                    Contains("the same values"));
  CHECK_THROWS_AS(analysis::power_law({fine, {{-1.0, 2.0}, {2.0, 1.0}}}), core::InvalidInput);
}

TEST_CASE("one participant has an exponent without an interval, and equal numbers no R squared",
          "[analysis][magnitudes]") {
  const auto law = analysis::power_law({{{1.0, 2.0}, {10.0, 6.0}}});
  CHECK(law.exponent == Approx(std::log10(3.0)).epsilon(1e-12));
  CHECK_FALSE(law.exponent_interval);
  const auto flat = analysis::power_law({{{1.0, 5.0}, {10.0, 5.0}}});
  CHECK(flat.exponent == 0.0);
  CHECK_FALSE(flat.r_squared);
}

TEST_CASE("of two items the interval over participants is that of a logit, each left out in turn",
          "[analysis][paired]") {
  const std::vector<std::pair<int, int>> answers{{9, 3}, {2, 4}, {10, 2}, {7, 5}};
  std::vector<PairedCounts> people;
  double wins = 0.0;
  double all = 0.0;
  for (const auto& [won, lost] : answers) {
    people.push_back(counts_of(square({0, won, lost, 0})));
    wins += won;
    all += won + lost;
  }
  const double p = wins / all;
  double variance = 0.0;
  for (const auto& [won, lost] : answers) {
    const double own = won + lost;
    const double change = (won - own * p) / ((all - own) * p * (1.0 - p));
    variance += 0.75 * change * change;
  }
  const auto logit = analysis::difference(analysis::bradley_terry(people).scale, 0, 1);
  constexpr double t_of_three = 3.182446305284263;
  CHECK(logit.value == Approx(std::log(p / (1.0 - p))).epsilon(1e-10));
  CHECK(logit.standard_error == Approx(std::sqrt(variance)).epsilon(1e-9));
  CHECK(logit.interval.high ==
        Approx(logit.value + t_of_three * std::sqrt(variance)).epsilon(1e-9));
}

TEST_CASE("participants who agree do not make an interval of no width", "[analysis][paired]") {
  const PairedCounts own = counts_of(square({0, 3, 1, 0}));
  const auto of_all = analysis::difference(analysis::bradley_terry({own, own, own}).scale, 0, 1);
  // independent answers: 1 / 9 + 1 / 3
  CHECK(of_all.standard_error == Approx(std::sqrt(0.05 * (1.0 / 9.0 + 1.0 / 3.0))).epsilon(1e-9));
}

TEST_CASE("an item that one of several participants judged has an interval without ends",
          "[analysis][paired]") {
  const std::vector<PairedCounts> people{counts_of(square({0, 2, 3, 1, 0, 2, 1, 1, 0})),
                                         counts_of(square({0, 2, 0, 1, 0, 0, 0, 0, 0})),
                                         counts_of(square({0, 1, 0, 2, 0, 0, 0, 0, 0}))};
  const auto last = analysis::difference(analysis::bradley_terry(people).scale, 0, 2);
  CHECK(std::isfinite(last.value));
  CHECK(std::isinf(last.interval.low));
  CHECK(std::isinf(last.interval.high));
  CHECK(last.p == 1.0);
}
