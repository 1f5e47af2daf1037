// Scales from paired comparisons, against the R packages BradleyTerry2 and stats.
#include <cmath>
#include <vector>

#include "analysis/paired/bradley_terry.hpp"
#include "analysis/paired/thurstone.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/r_program.hpp"
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
  const auto ours = analysis::bradley_terry(without_ties);
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
  const auto ours = analysis::bradley_terry(with_ties);
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
  check_differences(analysis::thurstone_case_v(with_ties), expected, 1e-9);
}

TEST_CASE("two items are as far apart as the logit or probit of their preferences",
          "[analysis][paired]") {
  const PairedCounts counts = counts_of(square({0, 30, 10, 0}));
  const auto logit = analysis::difference(analysis::bradley_terry(counts).scale, 0, 1);
  CHECK(logit.value == Approx(std::log(3.0)).epsilon(1e-10));
  CHECK(logit.standard_error == Approx(std::sqrt(1.0 / 30.0 + 1.0 / 10.0)).epsilon(1e-10));
  CHECK(analysis::difference(analysis::thurstone_case_v(counts), 0, 1).value ==
        Approx(0.674489750).epsilon(1e-9));
}

TEST_CASE("items that comparisons do not connect are refused by their places",
          "[analysis][paired]") {
  PairedCounts counts{square({0, 3, 2, 2, 1, 0, 2, 0, 0, 0, 0, 3, 0, 0, 1, 0}),
                      Eigen::MatrixXi::Zero(4, 4)};
  const auto refusal = Contains("of items 3, 4, none was ever preferred to any of items 1, 2");
  CHECK_THROWS_WITH(analysis::bradley_terry(counts), refusal);
  CHECK_THROWS_WITH(analysis::thurstone_case_v(counts), refusal);
  const PairedCounts reversed = counts_of(counts.wins.reverse());
  CHECK_THROWS_WITH(analysis::bradley_terry(reversed),
                    Contains("of items 1, 2, none was ever preferred to any of items 3, 4"));
  counts.ties(1, 3) = counts.ties(3, 1) = 1;  // half a preference of 4 to 2
  CHECK_THROWS_WITH(analysis::bradley_terry(counts), refusal);
  CHECK_NOTHROW(analysis::thurstone_case_v(counts));
}

TEST_CASE("paired counts of other shapes and pairs of one item are refused", "[analysis][paired]") {
  const auto refuses = [](const Eigen::MatrixXi& wins, const Eigen::MatrixXi& ties) {
    CHECK_THROWS_AS(analysis::bradley_terry(counts_of(wins, ties)), core::InvalidInput);
    CHECK_THROWS_AS(analysis::thurstone_case_v(counts_of(wins, ties)), core::InvalidInput);
  };
  const Eigen::MatrixXi fine = square({0, 3, 2, 0});
  refuses(Eigen::MatrixXi::Zero(1, 1), no_ties);
  refuses(Eigen::MatrixXi::Ones(2, 3), no_ties);
  refuses(Eigen::MatrixXi::Ones(2, 2), no_ties);
  refuses(-fine, no_ties);
  refuses(fine, square({0, 3, 2, 0}));
  refuses(fine, Eigen::MatrixXi::Zero(3, 3));
  const auto scale = analysis::bradley_terry(counts_of(fine)).scale;
  CHECK_THROWS_AS(analysis::difference(scale, 0, 0), core::InvalidInput);
  CHECK_THROWS_AS(analysis::difference(scale, 0, 2), core::InvalidInput);
}
