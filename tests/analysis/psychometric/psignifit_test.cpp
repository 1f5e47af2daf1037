// Psychometric functions with a free lapse rate, against psignifit (Wichmann & Hill 2001a).
#include <cmath>
#include <sstream>

#include "analysis/psychometric/example_levels.hpp"
#include "analysis/psychometric/fit.hpp"
#include "support/catch.hpp"
#include "support/processes.hpp"
#include "support/texts.hpp"
using namespace tapstudy;
using core::PsychometricShape;

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
