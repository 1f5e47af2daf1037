#include "analysis/statistics/population/planned_contrasts.hpp"

#include "analysis/statistics/population/means.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/reference_programs.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;
using testing::r_numbers;
using testing::r_vector;

TEST_CASE("equivalence is two one-sided tests by R's t.test", "[analysis][planned]") {
  const std::vector<double> differences{0.12, -0.03, 0.05, 0.21, -0.08, 0.02, 0.1};
  for (const double bound : {0.05, 0.15, 0.6}) {
    const EquivalenceTest test = equivalence_test(differences, bound);
    const auto by_r = r_numbers(fmt::format(
        "d <- {}; above <- t.test(d, mu = -{}, alternative = 'greater'); below <- t.test(d, mu = "
        "{}, alternative = 'less'); out(above$p.value, below$p.value, t.test(d, conf.level = "
        "0.9)$conf.int)",
        r_vector(differences), bound, bound));
    CHECK(test.p_above == Approx(by_r[0]));
    CHECK(test.p_below == Approx(by_r[1]));
    CHECK(test.p == std::max(test.p_above, test.p_below));
    CHECK(test.interval_90.low == Approx(by_r[2]));
    CHECK(test.interval_90.high == Approx(by_r[3]));
    CHECK((test.p < 0.05) == (by_r[2] > -bound && by_r[3] < bound));
  }
  CHECK_THROWS_AS(equivalence_test(std::vector{0.1, 0.1, 0.1}, 1.0), core::NotEstimable);
  CHECK_THROWS_AS(equivalence_test(std::vector{0.1}, 1.0), core::InvalidInput);
  CHECK_THROWS_AS(equivalence_test(differences, 0.0), core::InvalidInput);
}

TEST_CASE("F of an interaction is that of R's repeated measures", "[analysis][planned]") {
  core::Rng rng{3};
  std::vector<LevelTable> people;
  std::vector<double> all;
  for (int person = 0; person < 6; ++person) {
    people.emplace_back();
    for (int row = 0; row < 2; ++row) {
      people.back().emplace_back();
      for (int column = 0; column < 3; ++column) {
        all.push_back(0.7 * person + row * column + rng.normal());
        people.back().back().push_back(all.back());
      }
    }
  }
  const InteractionTest test = interaction_test(people, 1);
  const auto by_r = r_numbers(
      "d <- expand.grid(b = factor(1:3), a = factor(1:2), p = factor(1:6)); d$y <- " +
      r_vector(all) +
      "; f <- summary(aov(y ~ a * b + Error(p / (a * b)), d))[['Error: p:a:b']][[1]]; "
      "out(f[1, 'F value'], f[1, 'Df'], f[2, 'Df'])\n"
      // all patterns of signs of each person's interaction
      "left <- sapply(split(d, d$p), function(one) residuals(lm(y ~ a + b, one)))\n"
      "far <- apply(expand.grid(rep(list(c(-1, 1)), 6)), 1, function(s) sum((left %*% s)^2))\n"
      "out(mean(far >= sum(rowSums(left)^2) * (1 - 1e-9)))");
  CHECK(test.f == Approx(by_r[0]));
  CHECK(test.numerator_freedom == by_r[1]);
  CHECK(test.denominator_freedom == by_r[2]);
  CHECK(test.is_exact);
  CHECK(test.p == Approx(by_r[3]));
}

TEST_CASE("an interaction of two levels each is the test of differences of differences",
          "[analysis][planned]") {
  core::Rng rng{4};
  for (const std::size_t number : {std::size_t{5}, std::size_t{16}}) {
    std::vector<LevelTable> people;
    std::vector<double> differences;
    for (std::size_t person = 0; person < number; ++person) {
      people.push_back({{rng.normal(), rng.normal() + 1.0}, {rng.normal(), rng.normal()}});
      const LevelTable& of = people.back();
      differences.push_back(of[0][0] - of[0][1] - of[1][0] + of[1][1]);
    }
    CHECK(interaction_test(people, 1).p == Approx(sign_flip_test(differences, 1).p));
  }
}

TEST_CASE("what has no interaction, or no table, is not tested", "[analysis][planned]") {
  const LevelTable additive{{1.0, 2.0}, {3.0, 4.0}};
  CHECK_THROWS_AS(interaction_test({additive, additive}, 1), core::NotEstimable);
  CHECK_THROWS_AS(interaction_test({additive}, 1), core::InvalidInput);
  CHECK_THROWS_AS(interaction_test({additive, {{1.0, 2.0}}}, 1), core::InvalidInput);
  CHECK_THROWS_AS(interaction_test({{{1.0}, {2.0}}, {{1.0}, {3.0}}}, 1), core::InvalidInput);
}
