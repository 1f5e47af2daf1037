#include <boost/math/distributions/beta.hpp>
#include <cmath>

#include "analysis/statistics/contingency/agreement.hpp"
#include "analysis/statistics/contingency/information_transfer.hpp"
#include "analysis/statistics/contingency/similarity.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/reference_programs.hpp"
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

TEST_CASE("symmetry and homogeneity of two classes are the test of equal proportions",
          "[analysis][agreement]") {
  for (const CountTable& table : {CountTable{{8, 3}, {2, 5}}, CountTable{{70, 10}, {9, 21}}}) {
    const auto r = r_numbers("m <- " + r_matrix(table) +
                             "; t <- suppressWarnings(prop.test(c(m[1, 2], m[2, 1]), rowSums(m), "
                             "correct = FALSE)); out(t$statistic, t$p.value)");
    for (const auto& test : {symmetry_test(table), homogeneity_test(table)}) {
      REQUIRE(test);
      CHECK(test->chi_squared == Approx(r[0]).epsilon(1e-9));
      CHECK(test->degrees_of_freedom == 1.0);
      CHECK(test->p == Approx(r[1]).epsilon(1e-9));
    }
  }
}

TEST_CASE("symmetry and homogeneity are tests of linear functions of multinomial rates",
          "[analysis][agreement]") {
  const std::vector<CountTable> tables{
      paper_table(), large_random_table(), {{3, 1, 2}, {4, 5, 6}, {1, 1, 1}}};
  std::string script = R"(
test <- function(d, V) {
  r <- qr(V)$rank
  x <- drop(t(d) %*% MASS::ginv(V) %*% d)
  out(x, r, pchisq(x, r, lower.tail = FALSE))
}
tests <- function(m) {
  k <- nrow(m); n <- rowSums(m); p <- as.vector(t(m / n))
  s <- (m + t(m)) / outer(n, n, '+'); diag(s) <- 0; diag(s) <- pmax(0, 1 - rowSums(s))
  V <- matrix(0, k^2, k^2)
  for (i in 1:k) {
    at <- (i - 1) * k + 1:k
    V[at, at] <- (sum(s[i, ]) * diag(s[i, ]) - s[i, ] %o% s[i, ]) / n[i]
  }
  cell <- function(i, j) as.numeric(seq_len(k^2) == (i - 1) * k + j)
  A <- NULL
  for (i in 1:(k - 1)) for (j in (i + 1):k)
    if (m[i, j] + m[j, i] > 0) A <- rbind(A, cell(i, j) - cell(j, i))
  test(A %*% p, A %*% V %*% t(A))
  A <- kronecker(t(rep(1, k)), diag(k))
  test(A %*% p - 1, A %*% V %*% t(A))
}
)";
  for (const CountTable& table : tables) {
    script += "tests(" + r_matrix(table) + ")\n";
  }
  const auto expected = r_numbers(script);
  std::size_t at = 0;
  for (const CountTable& table : tables) {
    for (const auto& test : {symmetry_test(table), homogeneity_test(table)}) {
      REQUIRE(test);
      CHECK(test->chi_squared == Approx(expected[at]).epsilon(1e-7));
      CHECK(test->degrees_of_freedom == expected[at + 1]);
      CHECK(test->p == Approx(expected[at + 2]).epsilon(1e-6).margin(1e-15));
      at += 3;
    }
  }
}

TEST_CASE("pairs that were never confused and classes that never occur change no test of symmetry",
          "[analysis][agreement]") {
  const CountTable table{{8, 3}, {2, 5}};
  const CountTable padded{{8, 0, 3}, {0, 0, 0}, {2, 0, 5}};
  for (const auto test : {symmetry_test, homogeneity_test}) {
    CHECK(test(padded)->chi_squared == Approx(test(table)->chi_squared).epsilon(1e-9));
    CHECK(test(padded)->degrees_of_freedom == 1.0);
    CHECK_FALSE(test({{3, 0}, {0, 4}}));
    CHECK_FALSE(test({{0, 0}, {0, 0}}));
  }
  CHECK(homogeneity_test(table_with_a_class_never_answered())->degrees_of_freedom == 2.0);
}

TEST_CASE("presenting a class twice as often makes answers no less symmetric",
          "[analysis][agreement]") {
  const CountTable symmetric{{60, 20, 20}, {40, 100, 60}, {20, 30, 50}};
  CHECK(symmetry_test(symmetric)->chi_squared == Approx(0.0).margin(1e-9));
  CHECK(homogeneity_test(symmetric)->chi_squared == Approx(0.0).margin(1e-9));
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

TEST_CASE("the similarity-choice model is the log-linear model of quasi-symmetry, as R fits it",
          "[analysis][similarity]") {
  for (const CountTable& table :
       {paper_table(), large_random_table(), CountTable{{9, 2, 1}, {4, 7, 3}, {1, 2, 12}}}) {
    const auto r = r_numbers(
        "m <- " + r_matrix(table) +
        "; k <- nrow(m); d <- expand.grid(i = 1:k, j = 1:k); d$n <- m[cbind(d$i, d$j)];"
        "d$s <- factor(paste(pmin(d$i, d$j), pmax(d$i, d$j)));"
        "f <- glm(n ~ factor(i) + factor(j) + s, poisson, d, control = list(epsilon = 1e-10, "
        "maxit = 50)); p <- matrix(fitted(f), k); p <- p / rowSums(p);"
        "e <- sqrt(p * t(p) / outer(diag(p), diag(p)));"
        "b <- sapply(1:k, function(j) 1 / sum(sqrt(p[j, ] * diag(p) / (p[, j] * p[j, j]))));"
        "out(deviance(f), f$df.residual, b, t(e))");
    const SimilarityChoice model = similarity_choice(table);
    REQUIRE(model.refusal.empty());
    CHECK(model.g_squared == Approx(r[0]).epsilon(1e-9));
    CHECK(model.degrees_of_freedom == static_cast<int>(r[1]));
    const std::size_t k = table.size();
    for (std::size_t i = 0; i < k; ++i) {
      CHECK(model.biases[i] == Approx(r[2 + i]).epsilon(1e-9));
      for (std::size_t j = 0; j < k; ++j) {
        CHECK(model.similarities[i][j] == Approx(r[2 + k + i * k + j]).epsilon(1e-9));
      }
    }
  }
}

TEST_CASE("counts that the similarity-choice model makes are fitted without a residue",
          "[analysis][similarity]") {
  const std::vector<double> biases{0.2, 0.3, 0.5};
  const std::vector<std::vector<double>> similarities{
      {1, 0.5, 0.1}, {0.5, 1, 0.25}, {0.1, 0.25, 1}};
  CountTable table(3, std::vector<std::int64_t>(3));
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      sum += biases[j] * similarities[i][j];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      table[i][j] = std::llround(1e12 * biases[j] * similarities[i][j] / sum);
    }
  }
  const SimilarityChoice model = similarity_choice(table);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(model.biases[i] == Approx(biases[i]).epsilon(1e-9));
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(model.similarities[i][j] == Approx(similarities[i][j]).epsilon(1e-9));
    }
  }
}

TEST_CASE("a pair that was never confused has a similarity of 0 and no degree of freedom",
          "[analysis][similarity]") {
  const SimilarityChoice model = similarity_choice(table_with_zeros());
  REQUIRE(model.refusal.empty());
  CHECK(model.similarities[0][3] == 0.0);
  CHECK(model.degrees_of_freedom == 0);  // 3 less the pairs 1-3, 1-4 and 2-4
  CHECK(model.p == 1.0);
}

TEST_CASE("without right answers of a class there are no similarities", "[analysis][similarity]") {
  CHECK_FALSE(similarity_choice(table_with_a_class_never_answered()).refusal.empty());
  CHECK_FALSE(similarity_choice(table_of_one_answer()).refusal.empty());
  CHECK_FALSE(similarity_choice({{3}}).refusal.empty());
  CHECK_THROWS_AS(similarity_choice({{1, 2, 3}, {4, 5, 6}}), core::InvalidInput);
}

TEST_CASE("a map is R's classical scaling", "[analysis][similarity]") {
  const auto distances = distances_of(similarity_choice(paper_table()).similarities);
  std::vector<double> flat;
  for (const auto& row : distances) {
    flat.insert(flat.end(), row.begin(), row.end());
  }
  const auto r = r_numbers("d <- matrix(" + r_vector(flat) +
                           ", 4); f <- cmdscale(d, 2, eig = TRUE); out(f$eig[1:2], f$GOF[1], "
                           "dist(f$points))");
  const ScaledMap map = classical_scaling(distances, 2);
  CHECK(map.eigenvalues[0] == Approx(r[0]).epsilon(1e-9));
  CHECK(map.eigenvalues[1] == Approx(r[1]).epsilon(1e-9));
  CHECK(map.explained == Approx(r[2]).epsilon(1e-9));
  std::size_t at = 3;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      CHECK(std::hypot(map.points[i][0] - map.points[j][0], map.points[i][1] - map.points[j][1]) ==
            Approx(r[at]).epsilon(1e-9));
      ++at;
    }
  }
}

TEST_CASE("points of a plane are found again from their distances", "[analysis][similarity]") {
  const std::vector<std::vector<double>> distances{{0, 3, 5}, {3, 0, 4}, {5, 4, 0}};
  const ScaledMap map = classical_scaling(distances, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(std::hypot(map.points[i][0] - map.points[j][0], map.points[i][1] - map.points[j][1]) ==
            Approx(distances[i][j]).margin(1e-12));
    }
  }
  CHECK(map.explained == Approx(1.0).epsilon(1e-9));
  CHECK_THROWS_AS(classical_scaling({{0, 1}, {2, 0}}, 1), core::InvalidInput);
  CHECK_THROWS_AS(classical_scaling(distances, 4), core::InvalidInput);
  CHECK_THROWS_AS(distances_of({{1.0, 0.0}, {0.0, 1.0}}), core::InvalidInput);
}
