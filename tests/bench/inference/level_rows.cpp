#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/psychometric/inference.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
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

std::string staircase_of(const std::string& trials) {
  return "staircase: {rule: transformed, n_down: 3, steps: factor, start: 3, min: 0.1, max: 10, "
         "first_step: 1.6, min_step: 1.15, stop: {trials: " +
         trials + "}, estimate_reversals: 6}";
}
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

// The upper end of the threshold of one who feels nothing; at most 1 in 20 has one.
Row threshold_of_guesser(const char* words, const std::string& procedure) {
  const Settings settings = testing::procedure_of(procedure);
  return {Kind::size,
          "tasks with procedures",
          fmt::format("an upper limit of a guesser's threshold, {} (columns alike)", words),
          By::people,
          [settings](const StudyDraw& draw) -> std::optional<Outcome> {
            const Observer::Parameters guesser{core::PsychometricShape::weibull, 1e3, 3.5, 0.5};
            const auto of = estimates_of(levels_of(*settings, guesser, draw.rng));
            return Outcome{of && std::isfinite(of->threshold_interval.high) ? 0.0 : 1.0, 0.0};
          },
          Cost::much};
}

// A value fitted to each of so many people, from whom all studies draw theirs: nobody has to do
// with anybody else, and a fit takes as long as thousands of draws. The error of their mean is a
// tenth of that of twenty of them.
class PooledPeople {
 public:
  using FitOfPerson = std::function<std::optional<double>(core::Rng&)>;
  explicit PooledPeople(FitOfPerson fit) : fit_{std::move(fit)} {}

  std::vector<double> drawn(const StudyDraw& draw) {
    std::call_once(is_fitted_, [&] {
      analysis::parallel_for(values_.size(), 0, [&](std::size_t person) {
        core::Rng rng{person};
        values_[person] = fit_(rng);
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
  static constexpr std::uint32_t number = 2000;
  FitOfPerson fit_;
  std::once_flag is_fitted_;
  std::vector<std::optional<double>> values_{number};
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
        const auto of = estimates_of(levels_of(
            *settings, {core::PsychometricShape::weibull, threshold, 2.0, 0.5, 0.02}, rng));
        return of ? std::optional{std::log(of->threshold)} : std::nullopt;
      });
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
      threshold_of_one("QUEST+ of 40", grid + "40}}"),
      threshold_of_one("QUEST+ of 100", grid + "100}}"),
      threshold_of_one("5 levels of 20", constant),
      threshold_of_guesser("staircase of 18", staircase_of("18")),
      threshold_of_guesser("QUEST+ of 40", grid + "40}}"),
      threshold_of_guesser("5 levels of 20", constant),
      mean_threshold("staircase of 60", staircase_of("60")),
      mean_threshold("QUEST+ of 40", grid + "40}}"),
      {Kind::coverage, "equality", "one point of equality", By::people, equality_of_one,
       Cost::much},
      mean_equality(),
  };
}
}  // namespace tapstudy::bench
