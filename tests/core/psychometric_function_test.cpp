// Psychometric functions: their definitions, and python3-questplus for Weibull and Gaussian.
#include "core/psychometric_function.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <tuple>

#include "core/error.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
using namespace tapstudy;
using core::PsychometricShape;

TEST_CASE("psychometric functions are those of questplus", "[core][psychometric]") {
  const auto run = testing::run_program({"/usr/bin/python3", "-c", R"(
from questplus.psychometric_function import weibull, norm_cdf
for x in (0.1, 0.7, 1.3, 4.0):
    a = dict(intensity=x, lapse_rate=0.03)
    for f in (weibull(threshold=1.1, slope=2.7, scale='linear', lower_asymptote=0.25, **a),
              weibull(threshold=1.1, slope=2.7, scale='log10', lower_asymptote=0.25, **a),
              norm_cdf(mean=1.1, sd=0.8, lower_asymptote=0.03, **a)):
        print(repr(float(f)))
)"});
  INFO(run.standard_error);
  REQUIRE(run.exit_code == 0);
  std::istringstream theirs{run.standard_output};
  for (const double x : {0.1, 0.7, 1.3, 4.0}) {
    // its norm_cdf begins at the lapse rate: the same where both rates are equal
    for (const auto& [shape, slope, guess] :
         {std::tuple{PsychometricShape::weibull, 2.7, 0.25},
          {PsychometricShape::gumbel, 2.7, 0.25},
          {PsychometricShape::cumulative_gaussian, 1.0 / 0.8, 0.03}}) {
      double expected = 0.0;
      REQUIRE(theirs >> expected);
      CHECK(core::proportion(shape, x, 1.1, slope, guess, 0.03) == Approx(expected).epsilon(1e-12));
    }
  }
}

TEST_CASE("at its threshold a shape is at half, Weibull's at 1 - 1/e", "[core][psychometric]") {
  for (const auto& row : core::psychometric_shapes()) {
    INFO(row.name);
    const bool is_weibull =
        row.shape == PsychometricShape::weibull || row.shape == PsychometricShape::gumbel;
    const double expected = is_weibull ? 1.0 - std::exp(-1.0) : 0.5;
    CHECK(core::shape_value(row.shape, 0.3, 0.3, 2.0) == Approx(expected).epsilon(1e-14));
    CHECK(&core::row_of(row.shape) == &row);
    CHECK(core::find_psychometric_shape(row.name) == &row);
  }
  CHECK(core::find_psychometric_shape("step") == nullptr);
  CHECK(core::shape_value(PsychometricShape::logistic, 3.0, 1.0, 0.5) ==
        Approx(1.0 / (1.0 + std::exp(-1.0))).epsilon(1e-14));
}

TEST_CASE("a shape of the logarithm is the other shape at the logarithms", "[core][psychometric]") {
  using enum PsychometricShape;
  for (const auto& [of_logarithm, plain] : {std::pair{weibull, gumbel},
                                            {log_logistic, logistic},
                                            {log_gaussian, cumulative_gaussian}}) {
    INFO(core::row_of(of_logarithm).name);
    CHECK(core::shape_value(of_logarithm, 0.4, 2.5, 3.0) ==
          Approx(core::shape_value(plain, std::log10(0.4), std::log10(2.5), 3.0)).epsilon(1e-13));
    CHECK(core::shape_value(of_logarithm, 0.0, 2.5, 3.0) == 0.0);
  }
}

TEST_CASE("the value found for a proportion has that proportion", "[core][psychometric]") {
  for (const auto& row : core::psychometric_shapes()) {
    for (const double level : {0.26, 0.5, 0.75, 0.96}) {
      INFO(row.name << " at " << level);
      const double x = core::value_at_proportion(row.shape, level, 0.8, 1.7, 0.25, 0.03);
      CHECK(core::proportion(row.shape, x, 0.8, 1.7, 0.25, 0.03) == Approx(level).epsilon(1e-12));
    }
  }
}

TEST_CASE("a psychometric function refuses what it is not defined for", "[core][psychometric]") {
  using enum PsychometricShape;
  CHECK_THROWS_AS(core::shape_value(weibull, -1.0, 1.0, 1.0), core::InvalidInput);
  CHECK_NOTHROW(core::shape_value(gumbel, -1.0, -1.0, 1.0));
  CHECK_THROWS_AS(core::shape_value(weibull, 1.0, 0.0, 1.0), core::InvalidInput);
  CHECK_THROWS_AS(core::shape_value(logistic, 1.0, 1.0, 0.0), core::InvalidInput);
  CHECK_THROWS_AS(core::shape_value(logistic, std::nan(""), 1.0, 1.0), core::InvalidInput);
  CHECK_THROWS_AS(core::proportion(logistic, 1.0, 1.0, 1.0, 0.6, 0.4), core::InvalidInput);
  CHECK_THROWS_AS(core::proportion(logistic, 1.0, 1.0, 1.0, -0.1, 0.0), core::InvalidInput);
  CHECK_THROWS_AS(core::value_at_proportion(logistic, 0.5, 1.0, 1.0, 0.5, 0.0), core::InvalidInput);
  CHECK_THROWS_AS(core::shape_quantile(logistic, 1.0, 1.0, 1.0), core::InvalidInput);
}

TEST_CASE("a shape's derivatives are the limits of its differences", "[core][psychometric]") {
  for (const auto& row : core::psychometric_shapes()) {
    INFO(row.name);
    constexpr double threshold = 1.3;
    constexpr double slope = 2.4;
    constexpr double h = 1e-4;
    const double on_axis = row.is_logarithmic ? std::log10(threshold) : threshold;
    const auto value = [&](double x, double along_axis, double along_slope) {
      const double at = on_axis + along_axis;
      return core::shape_value(row.shape, x, row.is_logarithmic ? std::pow(10.0, at) : at,
                               slope * std::exp(along_slope));
    };
    for (const double x : {0.2, 0.9, 1.3, 2.0}) {
      const auto found = core::shape_gradient(row.shape, x, threshold, slope);
      CHECK(found.value == value(x, 0.0, 0.0));
      CHECK(found.by_threshold ==
            Approx((value(x, h, 0.0) - value(x, -h, 0.0)) / (2.0 * h)).epsilon(1e-6).margin(1e-9));
      CHECK(found.by_log_slope ==
            Approx((value(x, 0.0, h) - value(x, 0.0, -h)) / (2.0 * h)).epsilon(1e-6).margin(1e-9));
    }
  }
  // far below it, also where a logarithm ends
  const auto none = core::shape_gradient(core::PsychometricShape::weibull, 0.0, 1.0, 2.0);
  CHECK((none.value == 0.0 && none.by_threshold == 0.0 && none.by_log_slope == 0.0));
}
