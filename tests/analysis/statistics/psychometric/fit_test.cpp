// Psychometric functions by maximum likelihood, against R's glm, psyphy's links and R's optim.
#include "analysis/statistics/psychometric/fit.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include "analysis/statistics/psychometric/example_levels.hpp"
#include "core/error.hpp"
#include "core/random/rng.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using analysis::FitOutcome;
using analysis::Level;
using analysis::PsychometricModel;
using core::PsychometricShape;
using testing::choice_levels;
using testing::yes_no_levels;

namespace {
FitOutcome outcome_of(const PsychometricModel& model, const std::vector<Level>& levels) {
  const auto fit = analysis::fit_psychometric(model, levels);
  CHECK(fit.curve.has_value() == (fit.outcome == FitOutcome::fitted));
  return fit.outcome;
}
}  // namespace

TEST_CASE("without guesses and lapses a psychometric function is R's generalised linear model",
          "[analysis][psychometric]") {
  const std::vector<double> expected = testing::r_numbers(testing::r_levels(yes_no_levels) + R"(
control <- glm.control(epsilon = 1e-14, maxit = 100)
tell <- function(u, link, to_slope, to_value) {
  g <- glm(cbind(k, n - k) ~ u, family = binomial(link), control = control)
  for (more in 1:30) g <- glm(cbind(k, n - k) ~ u, family = binomial(link), control = control, start = coef(g))
  a <- coef(g)[[1]]; b <- coef(g)[[2]]
  out(to_value(-a / b), b * to_slope, deviance(g))
}
tell(x, 'logit', 1, identity)
tell(x, 'probit', 1, identity)
tell(log10(x), 'logit', 1, function(t) 10^t)
tell(log10(x), 'probit', 1, function(t) 10^t)
tell(log10(x), 'cloglog', 1 / log(10), function(t) 10^t)
tell(x, 'cloglog', 1 / log(10), identity)
)");
  REQUIRE(expected.size() == 18);
  std::size_t next = 0;
  using enum PsychometricShape;
  for (const auto shape :
       {logistic, cumulative_gaussian, log_logistic, log_gaussian, weibull, gumbel}) {
    INFO(core::row_of(shape).name);
    const auto fit = analysis::fit_psychometric({shape, {0.0, 0.0}, {0.0, 0.0}}, yes_no_levels);
    REQUIRE(fit.curve);
    CHECK(fit.curve->threshold == Approx(expected[next++]).epsilon(1e-9));
    CHECK(fit.curve->slope == Approx(expected[next++]).epsilon(1e-9));
    CHECK(fit.deviance == Approx(expected[next++]).epsilon(1e-9));
  }
}

TEST_CASE("in a choice among m a psychometric function is a glm with psyphy's links",
          "[analysis][psychometric]") {
  const std::vector<double> expected = testing::r_numbers(testing::r_levels(choice_levels) + R"(
suppressMessages(library(psyphy))
control <- glm.control(epsilon = 1e-14, maxit = 200)
tell <- function(u, link, to_slope, to_value) {
  g <- glm(cbind(k, n - k) ~ u, family = binomial(link), control = control)
  for (more in 1:100) g <- glm(cbind(k, n - k) ~ u, family = binomial(link), control = control, start = coef(g))
  out(to_value(-coef(g)[[1]] / coef(g)[[2]]), coef(g)[[2]] * to_slope, deviance(g))
}
tell(x, mafc.logit(2), 1, identity)
tell(x, mafc.probit(2), 1, identity)
tell(log(x), mafc.weib(2), 1, exp)
tell(x, mafc.logit(4), 1, identity)
)");
  REQUIRE(expected.size() == 12);
  std::size_t next = 0;
  using enum PsychometricShape;
  for (const auto& [shape, guess] :
       {std::pair{logistic, 0.5}, {cumulative_gaussian, 0.5}, {weibull, 0.5}, {logistic, 0.25}}) {
    INFO(core::row_of(shape).name << " from " << guess);
    const auto fit = analysis::fit_psychometric({shape, {guess, guess}, {0.0, 0.0}}, choice_levels);
    const bool is_inside = expected[next] >= 0.5;  // the lowest level
    CHECK((fit.outcome == FitOutcome::fitted) == is_inside);
    CHECK(analysis::from_axis(shape, fit.maximum.at[analysis::threshold_at]) ==
          Approx(expected[next++]).epsilon(1e-9));
    CHECK(std::exp(fit.maximum.at[analysis::log_slope_at]) ==
          Approx(expected[next++]).epsilon(1e-9));
    CHECK(fit.deviance == Approx(expected[next++]).epsilon(1e-9));
  }
}

TEST_CASE("with free rates no start of R's optim finds a greater likelihood",
          "[analysis][psychometric]") {
  const std::vector<Level> levels{{1.0, {4, 60}},  {2.0, {7, 60}},  {3.0, {21, 60}},
                                  {4.0, {44, 60}}, {5.0, {55, 60}}, {6.0, {56, 60}},
                                  {8.0, {58, 60}}};
  const std::vector<double> expected = testing::r_numbers(testing::r_levels(levels) + R"(
minus <- function(q, guess) {
  if (guess) g <- q[4] else g <- 0
  p <- g + (1 - g - q[3]) * plogis(exp(q[2]) * (x - q[1]))
  -sum(dbinom(k, n, p, log = TRUE)) + sum(lchoose(n, k))
}
gradient <- function(q, guess) {
  if (guess) g <- q[4] else g <- 0
  e <- exp(q[2]); f <- plogis(e * (x - q[1])); p <- g + (1 - g - q[3]) * f
  steep <- (1 - g - q[3]) * f * (1 - f) * e
  of_p <- -(k / p - (n - k) / (1 - p))
  c(sum(of_p * -steep), sum(of_p * steep * (x - q[1])), sum(of_p * -f), if (guess) sum(of_p * (1 - f)) else 0)
}
best <- function(guess) {
  fits <- lapply(list(c(3, 0, .02, .02), c(4, .5, .05, .05), c(3.5, 1, .01, .01)), function(q)
    optim(q, minus, gradient, guess = guess, method = 'L-BFGS-B', lower = c(1, -1, 1e-6, 1e-6),
          upper = c(8, 2, 0.1, 0.1), control = list(factr = 1, pgtol = 0, maxit = 1000)))
  b <- fits[[which.min(sapply(fits, `[[`, 'value'))]]
  free <- if (guess) 1:4 else 1:3
  for (step in 1:8) {  # values tell the place to seven digits, the score to all
    by <- function(i, h) (gradient(b$par + h * (seq_along(b$par) == i), guess))[free]
    H <- sapply(free, function(i) (by(i, 1e-6) - by(i, -1e-6)) / 2e-6)
    b$par[free] <- b$par[free] - solve(H, gradient(b$par, guess)[free])
  }
  out(-b$value, b$par[1], exp(b$par[2]), b$par[3], if (guess) b$par[4] else 0)
}
best(FALSE); best(TRUE)
)");
  REQUIRE(expected.size() == 10);
  std::size_t next = 0;
  for (const double max_guess : {0.0, 0.1}) {
    const auto fit = analysis::fit_psychometric(
        {PsychometricShape::logistic, {0.0, max_guess}, {0.0, 0.1}}, levels);
    REQUIRE(fit.curve);
    CHECK(fit.maximum.log_likelihood >= expected[next] - 1e-7);
    CHECK(fit.maximum.log_likelihood == Approx(expected[next++]).margin(1e-9));
    CHECK(fit.curve->threshold == Approx(expected[next++]).epsilon(1e-9));
    CHECK(fit.curve->slope == Approx(expected[next++]).epsilon(1e-9));
    CHECK(fit.curve->lapse == Approx(expected[next++]).margin(1e-9));
    CHECK(fit.curve->guess == Approx(expected[next++]).margin(1e-9));
  }
}

TEST_CASE("answers in proportions that a function gives are fitted by that function",
          "[analysis][psychometric]") {
  for (const auto& row : core::psychometric_shapes()) {
    INFO(row.name);
    std::vector<Level> levels;
    for (const double x : {0.4, 0.7, 1.0, 1.4, 1.8, 2.3}) {
      const double p = core::proportion(row.shape, x, 1.1, 2.5, 0.5, 0.03);
      levels.push_back({x, {std::llround(1e12 * p), 1'000'000'000'000}});
    }
    const auto fit = analysis::fit_psychometric({row.shape, {0.5, 0.5}, {0.0, 0.1}}, levels);
    REQUIRE(fit.curve);
    CHECK(fit.curve->threshold == Approx(1.1).epsilon(1e-9));
    CHECK(fit.curve->slope == Approx(2.5).epsilon(1e-9));
    CHECK(fit.curve->lapse == Approx(0.03).margin(1e-9));
  }
}

TEST_CASE("no threshold is made up where the answers have none", "[analysis][psychometric]") {
  const PsychometricModel yes_no{PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.1}};
  const PsychometricModel choice{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  using enum FitOutcome;
  CHECK(outcome_of(yes_no, {{1.0, {9, 9}}, {2.0, {9, 9}}}) == all_successes);
  CHECK(outcome_of(yes_no, {{1.0, {0, 9}}, {2.0, {0, 9}}}) == no_successes);
  CHECK(outcome_of(yes_no, {{1.0, {5, 9}}, {2.0, {5, 9}}, {3.0, {5, 9}}}) == no_increase);
  CHECK(outcome_of(yes_no, {{1.0, {8, 9}}, {2.0, {5, 9}}, {3.0, {1, 9}}}) == no_increase);
  CHECK(outcome_of(choice, {{1.0, {8, 20}}, {2.0, {9, 20}}, {3.0, {7, 20}}}) == no_increase);
  CHECK(outcome_of(yes_no, {{1.0, {0, 9}}, {2.0, {0, 9}}, {3.0, {9, 9}}}) == step);
  CHECK(outcome_of(yes_no, {{1.0, {0, 9}}, {2.0, {4, 9}}, {3.0, {9, 9}}}) == step);
  CHECK(outcome_of(yes_no, {{1.0, {12, 20}}, {2.0, {14, 20}}, {3.0, {16, 20}}}) == threshold_below);
  CHECK(outcome_of(yes_no, {{1.0, {2, 20}}, {2.0, {3, 20}}, {3.0, {5, 20}}}) == threshold_above);
  // below the guess rate at first, but increasing: guesses alone explain it worse
  CHECK(outcome_of(choice, {{1.0, {5, 20}}, {2.0, {5, 20}}, {3.0, {13, 20}}}) != no_increase);
  CHECK(outcome_of(yes_no, yes_no_levels) == fitted);
  CHECK(outcome_of(choice, choice_levels) == fitted);
}

TEST_CASE("levels of one value count together, and none without trials",
          "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::logistic, {0.0, 0.0}, {0.0, 0.0}};
  std::vector<Level> split{{3.0, {0, 0}}};
  for (const Level& level : yes_no_levels) {
    const std::int64_t first = level.answers.successes / 2;
    split.push_back({level.value, {first, 20}});
    split.insert(split.begin(), {level.value, {level.answers.successes - first, 20}});
  }
  const auto fit = analysis::fit_psychometric(model, split);
  CHECK(fit.deviance ==
        Approx(analysis::fit_psychometric(model, yes_no_levels).deviance).epsilon(1e-12));
}

TEST_CASE("a fit refuses counts and values that are not possible", "[analysis][psychometric]") {
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  const auto refuses = [](const PsychometricModel& of, const std::vector<Level>& levels) {
    CHECK_THROWS_AS(analysis::fit_psychometric(of, levels), core::InvalidInput);
  };
  refuses(model, {});
  CHECK_THROWS_WITH(analysis::fit_psychometric(model, {{1.0, {3, 5}}, {1.0, {4, 5}}}),
                    Contains("two different values above 0 or more, not 1"));
  refuses(model, {{0.0, {3, 5}}, {1.0, {4, 5}}});  // one value has a logarithm
  refuses(model, {{1.0, {3, 5}}, {2.0, {0, 0}}});
  refuses(model, {{1.0, {6, 5}}, {2.0, {4, 5}}});
  refuses(model, {{1.0, {-1, 5}}, {2.0, {4, 5}}});
  refuses(model, {{-1.0, {3, 5}}, {2.0, {4, 5}}});
  refuses(model, {{std::nan(""), {3, 5}}, {2.0, {4, 5}}});
  refuses({PsychometricShape::weibull, {0.5, 0.4}, {0.0, 0.1}}, choice_levels);
  refuses({PsychometricShape::weibull, {0.0, 0.95}, {0.0, 0.1}}, choice_levels);
}

TEST_CASE("levels that differ by rounding only are fitted as one", "[analysis][psychometric]") {
  const double next = std::nextafter(1e5, 2e5);
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  const auto apart = analysis::fit_psychometric(
      model, {{5e4, {11, 20}}, {1e5, {8, 10}}, {next, {8, 10}}, {2e5, {19, 20}}});
  const auto one =
      analysis::fit_psychometric(model, {{5e4, {11, 20}}, {1e5, {16, 20}}, {2e5, {19, 20}}});
  REQUIRE(apart.curve);
  CHECK(apart.curve->threshold == Approx(one.curve->threshold).epsilon(1e-6));
}

namespace {
// The largest log-likelihood of a grid over the box.
double best_of_grid(const PsychometricModel& model, const std::vector<Level>& levels) {
  const analysis::BinomialLikelihood likelihood{model.shape, levels};
  const analysis::PsychometricBox box = analysis::search_box(model, levels);
  double best = -1e300;
  for (int i = 0; i <= 400; ++i) {
    for (int j = 0; j <= 40; ++j) {
      for (const double lapse : {0.0, 0.03, 0.06, 0.1}) {
        const double position = box.low[0] + i / 400.0 * (box.high[0] - box.low[0]);
        const double log_slope = box.low[1] + j / 40.0 * (box.high[1] - box.low[1]);
        best = std::max(best, likelihood.value({position, log_slope, model.guess.low, lapse}));
      }
    }
  }
  return best;
}

// Of a Weibull function of threshold 1 and slope 2, up by so many steps after a wrong answer.
std::vector<Level> staircase_levels(core::Rng& rng, int downs_after, int trials) {
  std::map<int, Level> levels;  // by step of 2 dB
  int step = 8;
  int right_in_row = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const double value = std::pow(10.0, step / 10.0);
    Level& level = levels.try_emplace(step, Level{value, {}}).first->second;
    const bool is_right = rng.uniform() < 0.5 + 0.48 * (1.0 - std::exp(-value * value));
    level.answers.add(is_right);
    right_in_row = is_right ? right_in_row + 1 : 0;
    step += is_right ? 0 : 1;
    if (right_in_row == downs_after) {
      right_in_row = 0;
      --step;
    }
  }
  std::vector<Level> all;
  for (const auto& [at, level] : levels) {
    all.push_back(level);
  }
  return all;
}
}  // namespace

// Lapses make likelihoods with several maxima: a gentle function, and steps between levels.
TEST_CASE("no point of a grid over the box is likelier than the fit", "[analysis][psychometric]") {
  core::Rng rng{7};
  for (int observer = 0; observer < 60; ++observer) {
    std::vector<Level> levels;
    for (const double value : {0.05, 0.1, 0.2, 0.4, 0.8, 1.6}) {
      Level level{value, {0, 12}};
      for (int trial = 0; trial < 12; ++trial) {
        level.answers.successes += rng.uniform() < 0.5 + 0.45 * (1.0 - std::exp(-3.0 * value));
      }
      levels.push_back(level);
    }
    const PsychometricModel model{PsychometricShape::cumulative_gaussian, {0.5, 0.5}, {0.0, 0.1}};
    CAPTURE(observer);
    CHECK(analysis::fit_psychometric(model, levels).maximum.log_likelihood >=
          best_of_grid(model, levels) - 1e-6);
  }
}

TEST_CASE("nor where a staircase left most trials at few levels",
          "[analysis][psychometric][slow]") {
  core::Rng rng{11};
  const PsychometricModel model{PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  for (int observer = 0; observer < 120; ++observer) {
    const std::vector<Level> levels = staircase_levels(rng, 1 + observer % 3, 60);
    CAPTURE(observer);
    CHECK(analysis::fit_psychometric(model, levels).maximum.log_likelihood >=
          best_of_grid(model, levels) - 1e-6);
  }
}

// Psychometric functions with a free lapse rate, against psignifit (Wichmann & Hill 2001a).
namespace {
struct Parameters {
  double alpha{};
  double beta{};
  double gamma{};
  double lambda{};
};

Parameters by_psignifit(const std::string& shape, const std::string& intervals,
                        const std::vector<analysis::Level>& levels) {
  const testing::TempDirectory directory;
  std::string input;
  for (const analysis::Level& level : levels) {
    input += fmt::format("{} {} {}\n", level.value, level.answers.value(), level.answers.trials);
  }
  input += "#shape " + shape + "\n#n_intervals " + intervals +
           "\n#runs 0\n#gamma_limits 0 0.1\n#lambda_limits 0 0.1\n#write_pa_est -\n";
  testing::write(directory / "input", input);
  const auto run = testing::run_program({"/usr/bin/psignifit", directory / "input"});
  const std::string all = run.standard_output + run.standard_error;
  const auto end_of_report = all.find('\n', all.find("r_kd"));
  REQUIRE(end_of_report != std::string::npos);
  std::istringstream numbers{all.substr(end_of_report)};
  Parameters found;
  char comma{};
  numbers >> found.alpha >> comma >> found.beta >> comma >> found.gamma >> comma >> found.lambda;
  INFO(all);
  REQUIRE(numbers);
  return found;
}
}  // namespace

TEST_CASE("with a free lapse rate a psychometric function is psignifit's, and as likely",
          "[analysis][psychometric]") {
  const auto compare = [](const analysis::PsychometricModel& model, const Parameters& theirs,
                          double their_slope, const std::vector<analysis::Level>& levels) {
    INFO(core::row_of(model.shape).name << " from " << model.guess.low);
    const auto fit = analysis::fit_psychometric(model, levels);
    REQUIRE(fit.curve);
    double more_likely = 0.0;
    for (const analysis::Level& level : levels) {
      const double ours = core::proportion(model.shape, level.value, fit.curve->threshold,
                                           fit.curve->slope, fit.curve->guess, fit.curve->lapse);
      const double others = core::proportion(model.shape, level.value, theirs.alpha, their_slope,
                                             theirs.gamma, theirs.lambda);
      CHECK(ours == Approx(others).margin(1e-2));  // their search stops early
      const auto right = static_cast<double>(level.answers.successes);
      const auto wrong = static_cast<double>(level.answers.trials) - right;
      more_likely +=
          right * std::log(ours / others) + wrong * std::log((1.0 - ours) / (1.0 - others));
    }
    CHECK(more_likely >= -1e-6);  // their parameters are printed with six digits
    CHECK(more_likely < 1e-2);
  };
  using enum PsychometricShape;
  const auto& choices = testing::choice_levels;
  const analysis::Interval lapse{0.0, 0.1};
  for (const auto& [intervals, guess] : {std::pair{"2", 0.5}, {"3", 1.0 / 3.0}}) {
    const auto as_weibull = by_psignifit("Weibull", intervals, choices);
    compare({weibull, {guess, guess}, lapse}, as_weibull, as_weibull.beta, choices);
    const auto as_logistic = by_psignifit("logistic", intervals, choices);
    compare({logistic, {guess, guess}, lapse}, as_logistic, 1.0 / as_logistic.beta, choices);
  }
  const auto gaussian = by_psignifit("cumulative Gaussian", "1", testing::yes_no_levels);
  compare({cumulative_gaussian, {0.0, 0.1}, lapse}, gaussian, 1.0 / gaussian.beta,
          testing::yes_no_levels);
}
