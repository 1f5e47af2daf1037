#include "analysis/information/information_transfer.hpp"

#include <boost/math/distributions/beta.hpp>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

namespace {
// Tables of people who answer each of four classes twice, and whose share of right answers is beta
// distributed about `right` with an intra-class correlation of 0.1.
std::vector<CountTable> differing_people(int participants, double right, core::Rng& rng) {
  constexpr double nu = 1.0 / 0.1 - 1.0;
  std::vector<CountTable> people;
  for (int person = 0; person < participants; ++person) {
    const double share = boost::math::quantile(
        boost::math::beta_distribution<>{nu * right, nu * (1.0 - right)}, rng.uniform());
    CountTable table(4, std::vector<std::int64_t>(4, 0));
    for (std::size_t trial = 0; trial < 8; ++trial) {
      const std::size_t stimulus = trial / 2;
      const std::size_t other = (stimulus + 1 + rng.below(3)) % 4;
      ++table[stimulus][rng.uniform() < share ? stimulus : other];
    }
    people.push_back(table);
  }
  return people;
}
}  // namespace

TEST_CASE(
    "information transfer is what the entropies of stimuli and answers have in common, each "
    "corrected by Miller and Madow",
    "[analysis][information]") {
  for (const CountTable& table : all_tables()) {
    const auto r =
        r_numbers("m <- " + r_matrix(table) +
                  "; n <- sum(m); h <- function(x) { x <- x[x > 0]; -sum(x / n * log2(x / n)) };"
                  "k <- function(x) (sum(x > 0) - 1) / (2 * n * log(2));"
                  "out(h(rowSums(m)) + h(colSums(m)) - h(m), h(rowSums(m)) + k(rowSums(m)) + "
                  "h(colSums(m)) + k(colSums(m)) - h(m) - k(m), sum(m > 0))");
    const InformationTransfer result = information_transfer(table);
    CHECK(result.bits == Approx(r[0]).margin(1e-12));
    CHECK(result.miller_madow_bits == Approx(r[1]).margin(1e-12));
    CHECK(result.occupied_cells == static_cast<int>(r[2]));
  }
}

TEST_CASE("perfect answers transfer log2 k bits, and 5 k^2 answers are the fewest that say so",
          "[analysis][information]") {
  const CountTable perfect{{20, 0, 0, 0}, {0, 20, 0, 0}, {0, 0, 20, 0}, {0, 0, 0, 20}};
  CHECK(information_transfer(perfect).bits == Approx(2.0).epsilon(1e-9));
  CHECK(fewest_answers_for_information(perfect) == 80);
  CHECK_THROWS_AS(information_transfer({{0, 0}, {0, 0}}), core::InvalidInput);
  CHECK_THROWS_AS(information_transfer({{1, 0}, {0}}), core::InvalidInput);
  CHECK_THROWS_AS(information_transfer({{1, -1}}), core::InvalidInput);
}

TEST_CASE("what guessing transfers is as in R's random tables of the same totals",
          "[analysis][information]") {
  constexpr int draws = 20'000;
  for (const CountTable& table : ordinary_tables()) {
    const auto r =
        r_numbers("set.seed(1); m <- " + r_matrix(table) +
                  "; n <- sum(m); e <- outer(rowSums(m), colSums(m)) / n; it <- function(x) "
                  "sum(ifelse(x > 0, x / n * log2(x / e), 0));"
                  "x <- sapply(r2dtable(20000, rowSums(m), colSums(m)), it);"
                  "out(mean(x), sd(x), median(x), quantile(x, .95))");
    const GuessedInformation guessed = guessed_information(shuffled_tables({table}), draws, 3);
    const double error = r[1] / std::sqrt(draws);
    CHECK(guessed.mean == Approx(r[0]).margin(6.0 * error));
    CHECK(guessed.median == Approx(r[2]).margin(10.0 * error));
    CHECK(guessed.quantile_95 == Approx(r[3]).margin(15.0 * error));
  }
}

TEST_CASE("guessing by each participant's own preferences transfers what differs between them",
          "[analysis][information]") {
  // two who always give one answer each: nothing can be shuffled
  const std::vector<CountTable> stubborn{{{4, 0}, {0, 0}}, {{0, 0}, {0, 4}}};
  const GuessedInformation guessed = guessed_information(shuffled_tables(stubborn), 99, 1);
  CHECK(guessed.mean == Approx(1.0).epsilon(1e-9));
  CHECK(guessed.p == 1.0);
  CHECK_THROWS_AS(guessed_information(shuffled_tables({}), 99, 1), core::InvalidInput);
  CHECK_THROWS_AS(guessed_information(shuffled_tables(stubborn), 0, 1), core::InvalidInput);
}

TEST_CASE("the interval of information is R's union of two jackknives over participants",
          "[analysis][information]") {
  const std::vector<CountTable> people{
      {{5, 1}, {2, 4}}, {{3, 3}, {1, 5}}, {{6, 0}, {0, 6}}, {{4, 2}, {4, 2}}, {{6, 0}, {1, 5}}};
  const auto r = r_numbers(
      "p <- list(matrix(c(5,2,1,4),2), matrix(c(3,1,3,5),2), matrix(c(6,0,0,6),2), "
      "matrix(c(4,4,2,2),2), matrix(c(6,1,0,5),2)); it <- function(m) { n <- sum(m); e <- "
      "outer(rowSums(m), colSums(m)) / n; sum(ifelse(m > 0, m / n * log2(m / e), 0)) + "
      "(sum(rowSums(m) > 0) + sum(colSums(m) > 0) - sum(m > 0) - 1) / (2 * n * log(2)) };"
      "all <- Reduce(`+`, p); ends <- function(f) { v <- sapply(p, function(x) f(it(all - x)));"
      "f(it(all)) + c(-1, 1) * qt(.975, 4) * sqrt(4 / 5 * sum((v - mean(v))^2)) };"
      "out(ends(identity), plogis(ends(qlogis)))");
  const auto interval = information_interval(people);
  REQUIRE(interval);
  CHECK(interval->low == Approx(std::max(0.0, std::min(r[0], r[2]))).margin(1e-9));
  CHECK(interval->high == Approx(std::max(r[1], r[3])).epsilon(1e-9));
  CHECK_FALSE(information_interval({people[0], people[1], people[2], people[3]}));
  CHECK_FALSE(information_interval(std::vector<CountTable>(6, people[0])));
}

TEST_CASE("the interval of information holds the true information in 94 % of studies or more",
          "[analysis][information][slow]") {
  constexpr int studies = 1000;
  constexpr int classes = 4;
  const auto bits_at = [](double right) {  // errors evenly among the others
    const double wrong = (1.0 - right) / (classes - 1);
    return 2.0 + right * std::log2(right) + (classes - 1) * wrong * std::log2(wrong);
  };
  for (const double right : {0.35, 0.5, 0.85}) {
    for (const int participants : {5, 10}) {
      core::Rng rng{7};
      int held = 0;
      int known = 0;
      for (int study = 0; study < studies; ++study) {
        const auto interval = information_interval(differing_people(participants, right, rng));
        known += interval ? 1 : 0;
        held += interval && interval->low <= bits_at(right) && bits_at(right) <= interval->high;
      }
      INFO(right << ", " << participants << " participants: " << held << " of " << known);
      CHECK(known > 0.95 * studies);
      CHECK(held >= (0.94 - 3.0 * std::sqrt(0.06 * 0.94 / known)) * known);
    }
  }
}
