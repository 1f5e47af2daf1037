#include <cmath>

#include "analysis/similarity/scaling.hpp"
#include "analysis/similarity/similarity_choice.hpp"
#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/confusion_tables.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using namespace tapstudy::testing;

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
