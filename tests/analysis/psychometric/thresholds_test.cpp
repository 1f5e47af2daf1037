// What is derived from thresholds: points of equality, differences, means over participants.
#include <catch2/catch.hpp>
#include <cmath>

#include "analysis/psychometric/comparison.hpp"
#include "analysis/psychometric/pooling.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
#include "support/r_program.hpp"
using namespace tapstudy;
using core::PsychometricShape;

TEST_CASE(
    "the difference threshold of a Gaussian is 0.6745 of its spread, of a logistic ln 3 over "
    "its slope",
    "[analysis][psychometric]") {
  const analysis::PsychometricCurve curve{10.5, 0.4, 0.02, 0.03, 0.0, 0.0};
  const auto gaussian =
      analysis::comparison_thresholds(PsychometricShape::cumulative_gaussian, curve, 10.0);
  CHECK(gaussian.point_of_subjective_equality == Approx(10.5).epsilon(1e-12));
  CHECK(gaussian.constant_error == Approx(0.5).epsilon(1e-10));
  CHECK(gaussian.just_noticeable_difference ==
        Approx(analysis::normal_quantile(0.75) / 0.4).epsilon(1e-12));
  CHECK(gaussian.weber_fraction ==
        Approx(gaussian.just_noticeable_difference / 10.0).epsilon(1e-14));
  const auto logistic = analysis::comparison_thresholds(PsychometricShape::logistic, curve, 10.0);
  CHECK(logistic.just_noticeable_difference == Approx(std::log(3.0) / 0.4).epsilon(1e-12));
  // Weibull: F = 1/2 is below the threshold, at (ln 2)^(1/slope) of it
  const auto weibull = analysis::comparison_thresholds(PsychometricShape::weibull, curve, 10.0);
  CHECK(weibull.point_of_subjective_equality ==
        Approx(10.5 * std::pow(std::log(2.0), 1.0 / 0.4)).epsilon(1e-12));
}

TEST_CASE("intervals of difference thresholds are inverse to those of slopes",
          "[analysis][psychometric]") {
  const analysis::PsychometricIntervals intervals{{9.0, 11.0}, {0.5, 2.0}};
  const auto ours = analysis::comparison_intervals(PsychometricShape::logistic, intervals, 20.0);
  REQUIRE(ours);
  CHECK(ours->point_of_subjective_equality.high == 11.0);
  CHECK(ours->just_noticeable_difference.low == Approx(std::log(3.0) / 2.0).epsilon(1e-12));
  CHECK(ours->just_noticeable_difference.high == Approx(std::log(3.0) / 0.5).epsilon(1e-12));
  CHECK(ours->weber_fraction.high == Approx(std::log(3.0) / 10.0).epsilon(1e-12));
  for (const auto shape :
       {PsychometricShape::weibull, PsychometricShape::gumbel, PsychometricShape::log_gaussian}) {
    CHECK_FALSE(analysis::comparison_intervals(shape, intervals, 20.0));
  }
  CHECK(analysis::weber_fraction(1.3, 10.0) == Approx(0.13).epsilon(1e-9));
  CHECK_THROWS_AS(analysis::weber_fraction(1.0, 0.0), core::InvalidInput);
  CHECK_THROWS_AS(analysis::weber_fraction(-1.0, 1.0), core::InvalidInput);
}

TEST_CASE("with equal standard errors the mean over participants is that of a t test",
          "[analysis][psychometric]") {
  const std::vector<double> values{1.2, 2.9, 1.7, 4.4, 2.2};
  const std::vector<double> expected =
      testing::r_numbers("y <- " + testing::r_vector(values) +
                         "; t <- t.test(y); out(t$estimate, t$stderr, t$conf.int, var(y) - 0.3^2)");
  std::vector<analysis::ParticipantEstimate> participants;
  for (const double value : values) {
    participants.push_back({value, 0.3});
  }
  const auto ours = analysis::pooled(participants);
  CHECK(ours.mean == Approx(expected.at(0)).epsilon(1e-12));
  CHECK(ours.standard_error == Approx(expected.at(1)).epsilon(1e-12));
  CHECK(ours.interval.low == Approx(expected.at(2)).epsilon(1e-10));
  CHECK(ours.interval.high == Approx(expected.at(3)).epsilon(1e-10));
  CHECK(ours.between_variance == Approx(expected.at(4)).epsilon(1e-10));
}

TEST_CASE("unequal participants are weighted by the moments of DerSimonian and Laird",
          "[analysis][psychometric]") {
  const std::vector<double> expected = testing::r_numbers(R"(
y <- c(1, 2, 4, 3.1); s <- c(0.2, 0.5, 0.9, 0.3); k <- length(y); w <- 1 / s^2
fixed <- lm(y ~ 1, weights = w); Q <- deviance(fixed)
tau2 <- (Q - (k - 1)) / (sum(w) - sum(w^2) / sum(w))
random <- lm(y ~ 1, weights = 1 / (s^2 + tau2))   # its standard error is Hartung & Knapp's
out(Q, pchisq(Q, k - 1, lower.tail = FALSE), tau2, coef(random), sqrt(vcov(random)), confint(random))
)");
  const auto ours = analysis::pooled({{1.0, 0.2}, {2.0, 0.5}, {4.0, 0.9}, {3.1, 0.3}});
  CHECK(ours.heterogeneity == Approx(expected.at(0)).epsilon(1e-10));
  CHECK(ours.heterogeneity_p == Approx(expected.at(1)).epsilon(1e-9));
  CHECK(ours.between_variance == Approx(expected.at(2)).epsilon(1e-10));
  CHECK(ours.mean == Approx(expected.at(3)).epsilon(1e-10));
  CHECK(ours.standard_error == Approx(expected.at(4)).epsilon(1e-10));
  CHECK(ours.interval.low == Approx(expected.at(5)).epsilon(1e-10));
  CHECK(ours.interval.high == Approx(expected.at(6)).epsilon(1e-10));
}

TEST_CASE("participants who differ by no more than their errors have no variance between them",
          "[analysis][psychometric]") {
  const auto ours = analysis::pooled({{1.0, 0.5}, {1.1, 0.5}, {0.9, 0.5}});
  CHECK(ours.between_variance == 0.0);
  CHECK(ours.mean == Approx(1.0).epsilon(1e-9));
  CHECK_THROWS_AS(analysis::pooled({{1.0, 0.5}}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::pooled({{1.0, 0.5}, {1.0, 0.0}}), core::InvalidInput);
  CHECK_THROWS_AS(analysis::pooled({{1.0, 0.5}, {std::nan(""), 1.0}}), core::InvalidInput);
}
