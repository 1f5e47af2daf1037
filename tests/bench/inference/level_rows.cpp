#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/hierarchical.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
#include "inference/people.hpp"
#include "inference/rows.hpp"
#include "support/procedures.hpp"
namespace tapstudy::bench {
namespace {
using analysis::Level;
using Settings = std::shared_ptr<const protocols::TrackSettings>;
using Observer = testing::KnownObserver;

std::vector<Level> levels_of(const protocols::TrackSettings& settings,
                             const Observer::Parameters& person, core::Rng& rng) {
  Observer observer{person, rng()};
  const auto track = settings.start(rng());
  std::map<double, analysis::Proportion> counts;
  testing::run(*track, [&](const std::vector<double>& values) {
    const std::size_t answer = observer.answer(values[0]);
    counts[values[0]].add(answer == 1);
    return answer;
  });
  std::vector<Level> levels;
  for (const auto& [value, of] : counts) {
    levels.push_back({value, of});
  }
  return levels;
}

const analysis::PsychometricModel threshold_model{
    core::PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};

std::optional<analysis::PosteriorEstimates> estimates_of(const std::vector<Level>& levels) {
  return psychometric_posterior(threshold_model, levels, 0.95, analysis::prior_breadth).estimates;
}

std::string staircase_of(const std::string& trials) {
  return "staircase: {rule: transformed, n_down: 3, steps: factor, start: 3, min: 0.1, max: 10, "
         "first_step: 1.6, min_step: 1.15, stop: {trials: " +
         trials + "}, estimate_reversals: 6}";
}
std::string quest_of(const std::string& trials) {
  return "quest_plus: {function: weibull, stimulus: {min: 0.1, max: 10, count: 25, spacing: log}, "
         "threshold: {min: 0.1, max: 10, count: 25, spacing: log}, slope: {values: [1, 2, 3.5, "
         "5]}, guess: {values: [0.5]}, lapse: {values: [0.02, 0.05]}, stop: {trials: " +
         trials + "}}";
}
std::string constants_of(const std::string& repetitions) {
  return "constant: {min: 0.3, max: 3, count: 5, spacing: log, repetitions: " + repetitions + "}";
}

// Of one person, with another slope and rate of lapses in each column.
Row posterior_of_one(
    const char* of_what, const char* words, const std::string& procedure,
    const std::function<Outcome(const analysis::PosteriorEstimates& of, double slope)>& outcome) {
  const Settings settings = testing::procedure_of(procedure);
  return {Kind::coverage, "tasks with procedures",
          fmt::format("one {}, {} (columns: slope 2, with 5 % lapses, slope .8, with lapses)",
                      of_what, words),
          By::people, [settings, outcome](const StudyDraw& draw) -> std::optional<Outcome> {
            const double slope = draw.people <= 5 ? 2.0 : 0.8;
            const double lapse = draw.people == 5 || draw.people == 20 ? 0.05 : 0.0;
            const auto of = estimates_of(levels_of(
                *settings, {core::PsychometricShape::weibull, 1.0, slope, 0.5, lapse}, draw.rng));
            return of ? std::optional{outcome(*of, slope)} : std::nullopt;
          }};
}

Row threshold_of_one(const char* words, const std::string& procedure) {
  return posterior_of_one("threshold", words, procedure,
                          [](const analysis::PosteriorEstimates& of, double /*slope*/) {
                            return holds(of.threshold_interval, 1.0);
                          });
}

Row slope_of_one(const char* words, const std::string& procedure) {
  return posterior_of_one("slope", words, procedure,
                          [](const analysis::PosteriorEstimates& of, double slope) {
                            return holds(of.slope_interval, slope);
                          });
}

// The upper end of the threshold of one who feels nothing; at most 1 in 20 has one. Tracks of 6 N
// trials, or N repetitions of five levels.
Row threshold_of_guesser(const char* words,
                         const std::function<std::string(const std::string&)>& procedure,
                         int trials_a_column) {
  std::map<int, Settings> settings;
  for (const int people : {3, 5, 8, 20}) {
    settings[people] = testing::procedure_of(procedure(std::to_string(trials_a_column * people)));
  }
  return {Kind::size, "tasks with procedures",
          fmt::format("an upper limit of a guesser's threshold, {}", words), By::people,
          [settings](const StudyDraw& draw) -> std::optional<Outcome> {
            const Observer::Parameters guesser{core::PsychometricShape::weibull, 1e3, 3.5, 0.5};
            const auto of = estimates_of(levels_of(*settings.at(draw.people), guesser, draw.rng));
            return Outcome{of && std::isfinite(of->threshold_interval.high) ? 0.0 : 1.0, 0.0};
          }};
}

// A value fitted to each of so many people, from whom all studies draw theirs: nobody has to do
// with anybody else, and a fit takes as long as thousands of draws. The error of their mean is a
// fifth of that of twenty of them.
class PooledPeople {
 public:
  using FitOfPerson = std::function<std::optional<double>(core::Rng&)>;
  explicit PooledPeople(FitOfPerson fit) : fit_{std::move(fit)} {}

  std::vector<double> drawn(const StudyDraw& draw) {
    std::call_once(is_fitted_, [&] {
      analysis::parallel_for(values_.size(), 0, [&](std::size_t person) {
        core::Rng rng{person};
        try {
          values_[person] = fit_(rng);
        } catch (const core::NotEstimable&) {  // who has no value is in no mean
        }
      });
    });
    std::vector<double> found;
    for (int person = 0; person < draw.people; ++person) {
      if (const auto& of = values_[draw.rng.below(number)]) {
        found.push_back(*of);
      }
    }
    return found;
  }

 private:
  static constexpr std::uint32_t number = 500;
  FitOfPerson fit_;
  std::once_flag is_fitted_;
  std::vector<std::optional<double>> values_ = std::vector<std::optional<double>>(number);
};

Row mean_of_people(const char* task, const std::string& statistic, double truth,
                   const PooledPeople::FitOfPerson& fit) {
  const auto people = std::make_shared<PooledPeople>(fit);
  return {Kind::coverage, task, statistic, By::people,
          [people, truth](const StudyDraw& draw) -> std::optional<Outcome> {
            const std::vector<double> found = people->drawn(draw);
            return found.size() > 1 ? std::optional{holds(analysis::t_interval(found), truth)}
                                    : std::nullopt;
          }};
}

// Of people whose thresholds are log-normal about 1.
Row mean_threshold(const char* words, const std::string& procedure) {
  const Settings settings = testing::procedure_of(procedure);
  return mean_of_people(
      "tasks with procedures", fmt::format("mean threshold, {}", words), 0.0,
      [settings](core::Rng& rng) -> std::optional<double> {
        const double threshold = rng.log_normal(1.0, 0.4);
        const auto levels = levels_of(
            *settings, {core::PsychometricShape::weibull, threshold, 2.0, 0.5, 0.02}, rng);
        const auto curve = analysis::curve_with_threshold(
            threshold_model, levels, analysis::fit_psychometric(threshold_model, levels));
        return curve ? std::optional{std::log(curve->threshold)} : std::nullopt;
      });
}

// One person answers as the function that is fitted.
std::optional<Outcome> deviance(const StudyDraw& draw) {
  static const Settings settings = testing::procedure_of(constants_of("20"));
  const auto levels =
      levels_of(*settings, {core::PsychometricShape::weibull, 1.0, 2.0, 0.5, 0.02}, draw.rng);
  return Outcome{analysis::deviance_test(threshold_model, levels, 99, draw.rng()).p};
}

// Thresholds are log-normal about 1 over people.
std::optional<Outcome> population_threshold(const StudyDraw& draw) {
  static const Settings settings = testing::procedure_of(constants_of("8"));
  std::vector<std::vector<Level>> people;
  for (int person = 0; person < draw.people; ++person) {
    const double threshold = draw.rng.log_normal(1.0, 0.4);
    people.push_back(levels_of(
        *settings, {core::PsychometricShape::weibull, threshold, 2.0, 0.5, 0.02}, draw.rng));
  }
  const auto fit = analysis::fit_population(threshold_model, people);
  return fit ? std::optional{holds(fit->interval, 1.0)} : std::nullopt;
}

const std::string either = "constant: {min: -2, max: 2, count: 7, repetitions: 12}";
const analysis::PsychometricModel equality_model{
    core::PsychometricShape::logistic, {0.0, 0.1}, {0.0, 0.1}, analysis::Rates::equal};

Observer::Parameters judge(core::Rng& rng) {
  return {core::PsychometricShape::logistic, 0.2 + 0.4 * rng.normal(), 2.0, 0.02, 0.02};
}

std::optional<Outcome> equality_of_one(const StudyDraw& draw, bool is_slope) {
  static const Settings settings = testing::procedure_of(either);
  const Observer::Parameters person = judge(draw.rng);
  const auto levels = levels_of(*settings, person, draw.rng);
  const analysis::PsychometricIntervals found = profile_intervals(equality_model, levels);
  return is_slope ? holds(found.slope, person.slope) : holds(found.threshold, person.threshold);
}

Row mean_equality() {
  const Settings settings = testing::procedure_of(either);
  return mean_of_people("equality", "mean point of equality", 0.2,
                        [settings](core::Rng& rng) -> std::optional<double> {
                          const Observer::Parameters person = judge(rng);
                          const auto fit =
                              fit_psychometric(equality_model, levels_of(*settings, person, rng));
                          return fit.curve ? std::optional{fit.curve->threshold} : std::nullopt;
                        });
}
}  // namespace

std::vector<Row> rows_of_levels() {
  return {
      threshold_of_one("staircase of 60", staircase_of("60")),
      threshold_of_one("QUEST+ of 40", quest_of("40")),
      threshold_of_one("QUEST+ of 100", quest_of("100")),
      threshold_of_one("5 levels of 20", constants_of("20")),
      slope_of_one("5 levels of 20", constants_of("20")),
      threshold_of_guesser("staircase of 6 N", staircase_of, 6),
      threshold_of_guesser("QUEST+ of 6 N", quest_of, 6),
      threshold_of_guesser("5 levels of N", constants_of, 1),
      {Kind::size, "tasks with procedures", "deviance of the fit, 5 levels of 20 (columns alike)",
       By::people, deviance},
      mean_threshold("staircase of 60", staircase_of("60")),
      mean_threshold("QUEST+ of 40", quest_of("40")),
      {Kind::coverage, "tasks with procedures", "all participants in one fit, 5 levels of 8",
       By::people, population_threshold},
      {Kind::coverage, "equality", "one point of equality (columns alike)", By::people,
       [](const StudyDraw& draw) { return equality_of_one(draw, false); }},
      {Kind::coverage, "equality", "one slope, which says the JND (columns alike)", By::people,
       [](const StudyDraw& draw) { return equality_of_one(draw, true); }},
      mean_equality(),
  };
}
}  // namespace tapstudy::bench
