#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>

#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
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

std::optional<analysis::PosteriorEstimates> estimates_of(const std::vector<Level>& levels) {
  const analysis::PsychometricModel model{core::PsychometricShape::weibull, {0.5, 0.5}, {0.0, 0.1}};
  return psychometric_posterior(model, levels, 0.95, analysis::prior_breadth).estimates;
}

const std::string staircase =
    "staircase: {rule: transformed, n_down: 3, steps: factor, start: 3, min: 0.1, max: 10, "
    "first_step: 1.6, min_step: 1.15, stop: {trials: 60}, estimate_reversals: 6}";
const std::string grid =
    "quest_plus: {function: weibull, stimulus: {min: 0.1, max: 10, count: 25, spacing: log}, "
    "threshold: {min: 0.1, max: 10, count: 25, spacing: log}, slope: {values: [1, 2, 3.5, 5]}, "
    "guess: {values: [0.5]}, lapse: {values: [0.02, 0.05]}, stop: {trials: ";
const std::string constant =
    "constant: {min: 0.3, max: 3, count: 5, spacing: log, repetitions: 20}";

// Of one person, with another slope and rate of lapses in each column.
Row threshold_of_one(const char* words, const std::string& procedure) {
  const Settings settings = testing::procedure_of(procedure);
  return {
      Kind::coverage,
      "tasks with procedures",
      fmt::format("one threshold, {} (columns: slope 2, with 5 % lapses, slope .8, with lapses)",
                  words),
      By::people,
      [settings](const StudyDraw& draw) -> std::optional<Outcome> {
        const double slope = draw.people <= 5 ? 2.0 : 0.8;
        const double lapse = draw.people == 5 || draw.people == 20 ? 0.05 : 0.0;
        const auto of = estimates_of(levels_of(
            *settings, {core::PsychometricShape::weibull, 1.0, slope, 0.5, lapse}, draw.rng));
        return of ? std::optional{holds(of->threshold_interval, 1.0)} : std::nullopt;
      },
      Cost::much};
}

// Of people whose thresholds are log-normal about 1.
Row mean_threshold(const char* words, const std::string& procedure) {
  const Settings settings = testing::procedure_of(procedure);
  return {
      Kind::coverage,
      "tasks with procedures",
      fmt::format("mean threshold, {}", words),
      By::people,
      [settings](const StudyDraw& draw) -> std::optional<Outcome> {
        std::vector<double> logarithms;
        for (int person = 0; person < draw.people; ++person) {
          const double threshold = draw.rng.log_normal(1.0, 0.4);
          const auto of = estimates_of(levels_of(
              *settings, {core::PsychometricShape::weibull, threshold, 2.0, 0.5, 0.02}, draw.rng));
          if (of) {
            logarithms.push_back(std::log(of->threshold));
          }
        }
        return logarithms.size() > 1 ? std::optional{holds(analysis::t_interval(logarithms), 0.0)}
                                     : std::nullopt;
      },
      Cost::much};
}

const std::string either = "constant: {min: -2, max: 2, count: 7, repetitions: 12}";
const analysis::PsychometricModel equality_model{
    core::PsychometricShape::logistic, {0.0, 0.1}, {0.0, 0.1}, analysis::Rates::equal};

Observer::Parameters judge(core::Rng& rng) {
  return {core::PsychometricShape::logistic, 0.2 + 0.4 * rng.normal(), 2.0, 0.02, 0.02};
}

std::optional<Outcome> equality_of_one(const StudyDraw& draw) {
  static const Settings settings = testing::procedure_of(either);
  Observer::Parameters person = judge(draw.rng);
  const auto levels = levels_of(*settings, person, draw.rng);
  return holds(profile_intervals(equality_model, levels).threshold, person.threshold);
}

std::optional<Outcome> mean_equality(const StudyDraw& draw) {
  static const Settings settings = testing::procedure_of(either);
  std::vector<double> found;
  for (int person = 0; person < draw.people; ++person) {
    const auto fit =
        fit_psychometric(equality_model, levels_of(*settings, judge(draw.rng), draw.rng));
    if (fit.curve) {
      found.push_back(fit.curve->threshold);
    }
  }
  return found.size() > 1 ? std::optional{holds(analysis::t_interval(found), 0.2)} : std::nullopt;
}
}  // namespace

std::vector<Row> rows_of_levels() {
  return {
      threshold_of_one("staircase of 60", staircase),
      threshold_of_one("QUEST+ of 40", grid + "40}}"),
      threshold_of_one("QUEST+ of 100", grid + "100}}"),
      threshold_of_one("5 levels of 20", constant),
      mean_threshold("staircase of 60", staircase),
      mean_threshold("QUEST+ of 40", grid + "40}}"),
      {Kind::coverage, "equality", "one point of equality", By::people, equality_of_one,
       Cost::much},
      {Kind::coverage, "equality", "mean point of equality", By::people, mean_equality, Cost::much},
  };
}
}  // namespace tapstudy::bench
