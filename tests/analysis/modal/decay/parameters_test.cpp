// From modes to what a protocol takes: Rayleigh's coefficients, Young's modulus, the sinusoid.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/modal/decay/decaying_sinusoid_fit.hpp"
#include "analysis/modal/modes/model_matching.hpp"
#include "analysis/modal/modes/rayleigh_fit.hpp"
#include "analysis/modal/modes/repeated_modes.hpp"
#include "core/error.hpp"
#include "core/model/modes/damping.hpp"
#include "support/catch.hpp"
#include "support/reference_programs.hpp"
#include "support/synthetic_taps.hpp"
using namespace tapstudy;
using namespace tapstudy::analysis;

namespace {
const std::vector<double> five_modes_hz{48.0, 97.0, 142.0, 231.0, 290.0};

std::vector<MeasuredRatio> ratios_of(const core::RayleighDamping& damping, double relative_error) {
  std::vector<MeasuredRatio> measured;
  for (const double frequency_hz : five_modes_hz) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz;
    const double ratio = core::damping_ratios(damping, Eigen::ArrayXd::Constant(1, omega))[0];
    measured.push_back({frequency_hz, ratio, relative_error * ratio});
  }
  return measured;
}

bool holds(const Interval& interval, double value) {
  return interval.low <= value && value <= interval.high;
}

std::vector<Estimate> estimates(const std::vector<double>& values) {
  std::vector<Estimate> all;
  for (const double value : values) {
    all.push_back({value, 0.001 * value, {0.998 * value, 1.002 * value}, std::nullopt});
  }
  return all;
}
}  // namespace

TEST_CASE("of two modes Rayleigh's coefficients are those of the paper's equation 13",
          "[analysis][modal]") {
  const core::RayleighDamping two = core::rayleigh_from_two_ratios(
      {0.05, 0.04}, 2.0 * std::numbers::pi * 50.0, 2.0 * std::numbers::pi * 200.0);
  const auto fit = fit_rayleigh({{50.0, 0.05, 0.001}, {200.0, 0.04, 0.004}});
  REQUIRE(fit);
  CHECK(fit->alpha_per_s.value == Approx(two.alpha_per_s));
  CHECK(fit->beta_s.value == Approx(two.beta_s));
  CHECK_FALSE(fit->p);  // nothing is left that could contradict
}

TEST_CASE("the weighted fit of ratios, its errors and chi-squared are NumPy's",
          "[analysis][modal]") {
  const auto fit = fit_rayleigh(
      {{50.0, 0.06, 0.002}, {100.0, 0.035, 0.001}, {150.0, 0.036, 0.002}, {250.0, 0.042, 0.003}});
  REQUIRE(fit);
  const auto numbers = testing::python_numbers(R"(
w = 2 * np.pi * np.array([50.0, 100.0, 150.0, 250.0])
z = np.array([0.06, 0.035, 0.036, 0.042]); s = np.array([0.002, 0.001, 0.002, 0.003])
A = np.c_[0.5 / w, 0.5 * w] / s[:, None]
x, rss, rank, sv = np.linalg.lstsq(A / np.linalg.norm(A, axis=0), z / s, rcond=None)
x = x / np.linalg.norm(A, axis=0)
chi = np.sum((A @ x - z / s)**2)
out(x, np.sqrt(np.diag(np.linalg.inv(A.T @ A)) * chi / 2), chi)
from scipy import stats
out(stats.chi2.sf(chi, 2), np.max(abs(0.5 * (x[0] / w + x[1] * w) / z - 1)))
)");
  CHECK(fit->alpha_per_s.value == Approx(numbers[0]));
  CHECK(fit->beta_s.value == Approx(numbers[1]));
  CHECK(fit->alpha_per_s.standard_error == Approx(numbers[2]));
  CHECK(fit->beta_s.standard_error == Approx(numbers[3]));
  CHECK(fit->chi_squared == Approx(numbers[4]));
  CHECK(*fit->p == Approx(numbers[5]));
  CHECK(fit->largest_misfit == Approx(numbers[6]));
}

TEST_CASE("planted Rayleigh coefficients lie inside 95 % of their intervals", "[analysis][modal]") {
  const core::RayleighDamping planted{30.0, 4e-5};
  core::Rng rng{8};
  constexpr int fits = 400;
  int alpha = 0;
  int beta = 0;
  for (int i = 0; i < fits; ++i) {
    auto measured = ratios_of(planted, 0.05);
    for (MeasuredRatio& one : measured) {
      one.ratio += one.standard_error * rng.normal();
    }
    const auto fit = fit_rayleigh(measured);
    alpha += holds(fit->alpha_per_s.interval, planted.alpha_per_s) ? 1 : 0;
    beta += holds(fit->beta_s.interval, planted.beta_s) ? 1 : 0;
  }
  // Where chi-squared exceeds its degrees of freedom intervals are wider than they need to be.
  const double low = 0.95 * fits - 3.3 * std::sqrt(fits * 0.95 * 0.05);
  CHECK(alpha >= low);
  CHECK(beta >= low);
}

TEST_CASE(
    "so they do where errors are known from few taps alone, and true laws are seldom rejected",
    "[analysis][modal]") {
  const core::RayleighDamping planted{30.0, 4e-5};
  const auto modes = GENERATE(std::size_t{2}, std::size_t{3}, std::size_t{5});
  const int taps = GENERATE(2, 3, 6);
  core::Rng rng{8};
  constexpr int fits = 400;
  int alpha = 0;
  int beta = 0;
  int rejected = 0;
  for (int i = 0; i < fits; ++i) {
    auto measured = ratios_of(planted, 0.1);
    measured.erase(measured.begin() + 1, measured.end() - static_cast<std::ptrdiff_t>(modes - 1));
    for (MeasuredRatio& one : measured) {
      std::vector<double> of_taps;
      for (int tap = 0; tap < taps; ++tap) {
        of_taps.push_back(one.ratio * (1.0 + 0.1 * rng.normal()));
      }
      const Estimate over =
          estimate_over_taps(of_taps, std::vector<double>(of_taps.size(), 1e-9), 100.0);
      one = {one.frequency_hz, over.value, over.standard_error, taps - 1.0};
    }
    const auto fit = fit_rayleigh(measured);
    alpha += holds(fit->alpha_per_s.interval, planted.alpha_per_s) ? 1 : 0;
    beta += holds(fit->beta_s.interval, planted.beta_s) ? 1 : 0;
    rejected += fit->p && *fit->p < 0.05 ? 1 : 0;
  }
  const double by_chance = 3.3 * std::sqrt(fits * 0.95 * 0.05);
  CHECK(alpha >= 0.95 * fits - by_chance);
  CHECK(beta >= 0.95 * fits - by_chance);
  CHECK(rejected <= 0.05 * fits + by_chance);
}

TEST_CASE("close modes are told apart over taps of which each shows another best",
          "[analysis][modal]") {
  const auto tap = [](double first_hz, double second_hz, double first_significance) {
    TapModes modes;
    for (const auto& [frequency_hz, significance] :
         {std::pair{first_hz, first_significance}, {second_hz, 1000.0 - first_significance}}) {
      TapMode& mode = modes.modes.emplace_back();
      mode.fitted.pole = {frequency_hz, 0.003};
      mode.fitted.frequency_error_hz = 0.001;
      mode.fitted.ratio_error = 1e-5;
      mode.fitted.significance = significance;
      mode.standing = Standing::agreed;
    }
    return modes;
  };
  TapModes alone = tap(100.002, 101.5, 400.0);
  alone.modes.pop_back();
  const auto modes = modes_over_taps(
      {alone, tap(100.0, 101.5, 900.0), tap(100.001, 101.501, 100.0), tap(99.999, 101.499, 700.0)});
  REQUIRE(modes.size() == 2);
  CHECK(modes[0].frequency_hz.value == Approx(100.0).margin(0.002));
  CHECK(modes[1].frequency_hz.value == Approx(101.5).margin(0.002));
  CHECK(modes[0].taps == 4);
  CHECK(modes[1].taps == 3);
}

TEST_CASE("a coefficient is never negative", "[analysis][modal]") {
  // falls faster than 1 / omega
  const auto fit = fit_rayleigh({{50.0, 0.08, 0.001}, {100.0, 0.03, 0.001}, {200.0, 0.01, 0.001}});
  REQUIRE(fit);
  CHECK(fit->is_bounded);
  CHECK(fit->beta_s.value == 0.0);
  CHECK(fit->alpha_per_s.value > 0.0);
  CHECK_FALSE(fit->fits());
  CHECK_FALSE(fit_rayleigh({{50.0, 0.08, 0.001}, {50.0, 0.07, 0.001}}));
  CHECK_THROWS_AS(fit_rayleigh({{50.0, 0.08, 0.0}, {90.0, 0.07, 0.001}}), core::InvalidInput);
}

TEST_CASE("Young's modulus follows the square of the frequencies", "[analysis][modal]") {
  const double factor = GENERATE(0.9, 1.0, 1.07);
  std::vector<double> measured;
  for (const double frequency_hz : {48.0, 142.0, 231.0}) {  // not every mode is excited
    measured.push_back(factor * frequency_hz);
  }
  const auto update = update_youngs_modulus(estimates(measured), five_modes_hz, 2.5e9);
  REQUIRE(update);
  CHECK(update->youngs_modulus_pa.value == Approx(2.5e9 * factor * factor));
  CHECK(update->matched[1].model == 2);
  CHECK(update->unmatched.empty());
  CHECK(update->rms_misfit < 1e-12);
}

TEST_CASE("the interval of Young's modulus holds what was planted, 95 times in 100",
          "[analysis][modal]") {
  core::Rng rng{4};
  constexpr int fits = 400;
  int inside = 0;
  for (int i = 0; i < fits; ++i) {
    std::vector<double> measured;
    for (const double frequency_hz : five_modes_hz) {
      measured.push_back(1.03 * frequency_hz * std::exp(0.01 * rng.normal()));
    }
    const auto update = update_youngs_modulus(estimates(measured), five_modes_hz, 1e9);
    inside += holds(update->youngs_modulus_pa.interval, 1.03 * 1.03 * 1e9) ? 1 : 0;
  }
  CHECK(std::abs(inside - 0.95 * fits) <= 3.3 * std::sqrt(fits * 0.95 * 0.05));
}

TEST_CASE("modes are assigned as SciPy's assignment does", "[analysis][modal]") {
  core::Rng rng{9};
  for (int i = 0; i < 5; ++i) {
    std::vector<double> model;
    for (int k = 0; k < 8; ++k) {
      model.push_back(60.0 * std::pow(1.25, k) * std::exp(0.03 * rng.normal()));
    }
    std::vector<double> measured;
    for (const std::size_t k : {1U, 2U, 5U, 6U}) {
      measured.push_back(model[k] * std::exp(0.02 * rng.normal()));
    }
    const auto update = update_youngs_modulus(estimates(measured), model, 1e9);
    REQUIRE(update);
    const double factor = std::sqrt(update->youngs_modulus_pa.value / 1e9);
    const auto columns = testing::python_numbers(
        fmt::format("from scipy.optimize import linear_sum_assignment\n"
                    "m, n = np.array({}), np.array({})\n"
                    "out(linear_sum_assignment(np.log(m[:, None] / n[None, :] / {})**2)[1])\n",
                    measured, model, factor));
    REQUIRE(update->matched.size() == columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      CHECK(update->matched[k].model == static_cast<std::size_t>(columns[k]));
    }
  }
}

TEST_CASE("Young's modulus is found from a stated one that is far off", "[analysis][modal]") {
  const double stated_over_true = GENERATE(0.3, 0.5, 0.75, 1.0, 1.6, 3.3);
  CAPTURE(stated_over_true);
  core::Rng rng{8};
  std::vector<double> model;
  std::vector<double> measured;
  for (int k = 0; k < 8; ++k) {
    model.push_back(60.0 * std::pow(1.25, k) * std::exp(0.1 * rng.normal()));
  }
  std::ranges::sort(model);
  for (const double hz : model) {
    measured.push_back(hz / std::sqrt(stated_over_true) * std::exp(1e-4 * rng.normal()));
  }
  const auto update = update_youngs_modulus(estimates(measured), model, stated_over_true * 3.2e9);
  REQUIRE(update);
  CHECK(update->matched.size() == 8);
  CHECK(update->youngs_modulus_pa.value == Approx(3.2e9).epsilon(1e-3));
  CHECK_FALSE(update->rival_pa);
}

TEST_CASE("a mode that the model does not have stays without a partner", "[analysis][modal]") {
  const auto update =
      update_youngs_modulus(estimates({48.0, 70.0, 97.0, 142.0}), five_modes_hz, 1e9);
  REQUIRE(update);
  CHECK(update->unmatched == std::vector<std::size_t>{1});
  CHECK(update->youngs_modulus_pa.value == Approx(1e9));
  CHECK_FALSE(update_youngs_modulus(estimates({20.0}), five_modes_hz, 1e9));
}

TEST_CASE("a decaying sinusoid and its errors are those of SciPy's curve_fit",
          "[analysis][modal]") {
  const auto numbers = testing::python_numbers(R"(
from scipy.optimize import curve_fit
rng = np.random.default_rng(6)
t = np.arange(400) / 20000.0
def y(t, A, B, f, t0, c):
  return A * np.exp(-B * (t - t0)) * np.sin(2 * np.pi * f * (t - t0)) + c
data = y(t, 3.0, 600.0, 250.0, 0.0002, 0.0) + 0.02 * rng.normal(size=len(t))
x, cov = curve_fit(y, t, data, p0=[3.0, 600.0, 250.0, 0.0002, 0.0])
out(x[:4], np.sqrt(np.diag(cov))[:3], data)
)");
  REQUIRE(numbers.size() == 407);
  const FreeDecay decay{20000.0, Eigen::Map<const Eigen::VectorXd>{numbers.data() + 7, 400}};
  const auto fit = fit_decaying_sinusoid(decay, {20.0, 2000.0});
  REQUIRE(fit);
  CHECK(fit->amplitude == Approx(numbers[0]).epsilon(1e-4));
  CHECK(fit->decay_per_s == Approx(numbers[1]).epsilon(1e-4));
  CHECK(fit->frequency_hz == Approx(numbers[2]).epsilon(1e-4));
  CHECK(fit->start_s == Approx(numbers[3]).margin(1e-7));
  CHECK(fit->amplitude_error == Approx(numbers[4]).epsilon(0.01));
  CHECK(fit->decay_error_per_s == Approx(numbers[5]).epsilon(0.01));
  CHECK(fit->frequency_error_hz == Approx(numbers[6]).epsilon(0.01));
  CHECK(fit->explained > 0.99);
}

TEST_CASE("a sensor that points the other way measures the same sinusoid", "[analysis][modal]") {
  FreeDecay decay = testing::planted_decay({{{250.0, 0.3}, 2.0}}, 20000.0, 0.02);
  const auto one = fit_decaying_sinusoid(decay, {20.0, 2000.0});
  decay.samples *= -1.0;
  const auto other = fit_decaying_sinusoid(decay, {20.0, 2000.0});
  REQUIRE((one && other));
  CHECK(one->amplitude == Approx(2.0).epsilon(1e-6));
  CHECK(other->amplitude == Approx(one->amplitude));
  CHECK(other->decay_per_s == Approx(one->decay_per_s));
}

TEST_CASE("amplitudes over impact speeds follow a line through the origin, as statsmodels fits it",
          "[analysis][modal]") {
  const auto law = amplitude_per_speed({0.1, 0.2, 0.4, 0.5}, {0.31, 0.58, 1.22, 1.49});
  const auto numbers = testing::python_numbers(R"(
import statsmodels.api as sm
r = sm.OLS([0.31, 0.58, 1.22, 1.49], [0.1, 0.2, 0.4, 0.5]).fit()
out(r.params, r.bse, r.conf_int())
)");
  CHECK(law.value == Approx(numbers[0]));
  CHECK(law.standard_error == Approx(numbers[1]));
  CHECK(law.interval.low == Approx(numbers[2]));
  CHECK(law.interval.high == Approx(numbers[3]));
  CHECK_THROWS_AS(amplitude_per_speed({0.0}, {1.0}), core::InvalidInput);
  CHECK_THROWS_AS(amplitude_per_speed({}, {}), core::InvalidInput);
}

TEST_CASE("a line of amplitudes over speeds is statsmodels', and says whether it is a proportion",
          "[analysis][modal]") {
  const std::vector<double> speeds{0.1, 0.2, 0.3, 0.4, 0.5};
  const std::vector<double> offset{1.52, 1.98, 2.51, 3.02, 3.47};
  const auto line = amplitude_line(speeds, offset);
  const auto numbers = testing::python_numbers(R"(
import statsmodels.api as sm
r = sm.OLS([1.52, 1.98, 2.51, 3.02, 3.47], sm.add_constant([0.1, 0.2, 0.3, 0.4, 0.5])).fit()
out(r.params, r.bse, r.conf_int())
)");
  REQUIRE(line);
  CHECK(line->offset.value == Approx(numbers[0]));
  CHECK(line->slope.value == Approx(numbers[1]));
  CHECK(line->offset.standard_error == Approx(numbers[2]));
  CHECK(line->slope.standard_error == Approx(numbers[3]));
  CHECK(line->offset.interval.low == Approx(numbers[4]));
  CHECK(line->slope.interval.high == Approx(numbers[7]));
  CHECK_FALSE(line->is_proportional());
  CHECK(amplitude_line(speeds, {0.49, 1.02, 1.51, 1.98, 2.51})->is_proportional());
  CHECK_FALSE(amplitude_line({0.1, 0.2}, {1.0, 2.0}));
  CHECK_FALSE(amplitude_line({0.2, 0.2, 0.2}, {1.0, 2.0, 3.0}));
}

TEST_CASE("over taps the interval is Student's, of one tap that of its noise",
          "[analysis][modal]") {
  const Estimate several = estimate_over_taps({1.0, 1.2, 1.1, 0.9, 1.3, 1.0, 1.1, 1.2},
                                              std::vector<double>(8, 9.0), 100.0);
  const auto numbers = testing::python_numbers(R"(
from scipy import stats
x = np.array([1.0, 1.2, 1.1, 0.9, 1.3, 1.0, 1.1, 1.2])
out(x.mean(), stats.t.interval(0.95, 7, x.mean(), stats.sem(x)), stats.t.interval(0.95, 30, 2.0, 0.1))
)");
  CHECK(several.value == Approx(numbers[0]));
  CHECK(several.interval.low == Approx(numbers[1]));
  CHECK(several.interval.high == Approx(numbers[2]));
  REQUIRE(several.bootstrap);
  CHECK(several.bootstrap->low == Approx(numbers[1]).epsilon(0.02));  // expanded to t's width
  const Estimate one = estimate_over_taps({2.0}, {0.1}, 30.0);
  CHECK(one.interval.low == Approx(numbers[3]));
  CHECK(one.interval.high == Approx(numbers[4]));
  CHECK_FALSE(one.bootstrap);
}
