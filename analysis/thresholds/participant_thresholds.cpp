#include "analysis/thresholds/participant_thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/resampling/parallel.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/thresholds/comparison_level.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr double max_lapse = 0.1;
constexpr int draws_of_fit = 200;
constexpr std::uint64_t draws_seed = 1;
constexpr double max_own_guess = 0.85;
// Levels of all participants together; about a hundred take a second of one processor.
constexpr std::size_t most_levels_examined = 1000;

void add_answer(ParticipantThreshold& person, const BlockDesign& design, const AnswerRow& answer) {
  if (!answer.is_correct) {
    throw core::InvalidInput{
        fmt::format("block '{}': the answer of {} to trial {} is neither right nor wrong",
                    design.name, answer.participant_id, answer.number)};
  }
  const std::optional<double> level = comparison_level(design, answer);
  if (!level) {
    person.false_alarms.add(!*answer.is_correct);
    return;
  }
  add_track_point(person.track, answer, *level, *answer.is_correct);
  person.correct.add(*answer.is_correct);
  count_at(person.levels, *level, *answer.is_correct);
}

std::vector<ParticipantThreshold> people_of(const BlockDesign& design,
                                            std::vector<AnswerRow> answers) {
  std::ranges::stable_sort(answers, {}, &AnswerRow::trial_id);
  std::map<std::string, ParticipantThreshold> people;
  for (const AnswerRow& answer : answers) {
    ParticipantThreshold& person = people[answer.participant_id];
    person.participant_id = answer.participant_id;
    add_answer(person, design, answer);
  }
  std::vector<ParticipantThreshold> sorted;
  for (auto& [name, person] : people) {
    sorted.push_back(std::move(person));
  }
  return sorted;
}

std::vector<Level> fitted_levels(const ParticipantThreshold& person, const BlockDesign& design) {
  std::vector<Level> levels = person.levels;
  if (design.has_own_guess_rate && person.false_alarms.trials > 0) {
    levels.push_back({0.0, person.false_alarms});
  }
  return levels;
}

void estimate(ParticipantThreshold& person, const PsychometricModel& model,
              const std::vector<Level>& levels, int draws) {
  try {
    const PsychometricFit fit = fit_psychometric(model, levels);
    const auto curve = curve_with_threshold(model, levels, fit);
    if (!curve) {
      person.no_threshold = explanation(fit.outcome);
      return;
    }
    person.estimate = {*curve, profile_intervals(model, levels), fit.outcome == FitOutcome::step,
                       core::proportion(model.shape, curve->threshold, curve->threshold,
                                        curve->slope, curve->guess, curve->lapse),
                       std::nullopt};
    if (draws > 0) {
      person.estimate->goodness = deviance_test(model, levels, draws, draws_seed);
    }
  } catch (const core::NotEstimable& error) {  // too few levels, or levels below 0
    person.no_threshold = error.what();
  }
}

void add_posterior(ParticipantThreshold& person, const PsychometricModel& model,
                   const std::vector<Level>& levels) {
  try {
    const PsychometricPosterior posterior = psychometric_posterior(model, levels);
    person.posterior = posterior.estimates;
    person.no_posterior = posterior.estimates ? "" : explanation(posterior.outcome);
  } catch (const core::NotEstimable& error) {
    person.no_posterior = error.what();
  }
}

std::optional<MeanLogThreshold> mean_of(const std::vector<ParticipantThreshold>& people) {
  std::vector<double> logarithms;
  for (const ParticipantThreshold& person : people) {
    if (person.estimate && person.estimate->curve.threshold > 0.0) {
      logarithms.push_back(std::log10(person.estimate->curve.threshold));
    }
  }
  if (logarithms.size() < 2) {
    return std::nullopt;
  }
  const MeanAndSpread spread = mean_and_spread(logarithms);
  return MeanLogThreshold{spread.mean, spread.standard_deviation, t_interval(logarithms),
                          static_cast<int>(logarithms.size())};
}
// Of a linear axis by the first order of the logarithm.
std::optional<PopulationThreshold> population_of(const std::vector<ParticipantThreshold>& people,
                                                 core::PsychometricShape shape) {
  std::vector<double> means;
  std::vector<double> errors;
  for (const ParticipantThreshold& person : people) {
    if (!person.posterior || !(person.posterior->threshold > 0.0)) {
      continue;
    }
    const Marginal& position = person.posterior->position;
    const bool is_logarithm = core::row_of(shape).is_logarithmic;
    means.push_back(is_logarithm ? position.mean : std::log10(person.posterior->threshold));
    errors.push_back(is_logarithm ? position.standard_deviation
                                  : position.standard_deviation /
                                        (person.posterior->threshold * std::numbers::ln10));
  }
  return means.size() < 3 ? std::nullopt
                          : std::optional{PopulationThreshold{random_effects(means, errors),
                                                              static_cast<int>(means.size())}};
}
}  // namespace

PsychometricModel model_of(const BlockDesign& design) {
  const Interval guess = design.has_own_guess_rate ? Interval{0.0, max_own_guess}
                                                   : Interval{design.guess_rate, design.guess_rate};
  return {design.shape, guess, {0.0, max_lapse}};
}

ThresholdResults participant_thresholds(const BlockDesign& design,
                                        const std::vector<AnswerRow>& answers) {
  if (!design.axis) {
    throw core::InvalidInput{
        fmt::format("block '{}': a threshold takes an axis to vary", design.name)};
  }
  ThresholdResults results;
  results.participants = people_of(design, answers);
  std::size_t levels = 0;
  for (const ParticipantThreshold& person : results.participants) {
    levels += person.levels.size();
  }
  const bool is_examined = levels <= most_levels_examined && !design.is_for_main_results;
  results.draws = is_examined ? draws_of_fit : 0;
  results.has_posteriors = is_examined;
  const PsychometricModel model = model_of(design);
  parallel_for(results.participants.size(), 0, [&](std::size_t i) {
    ParticipantThreshold& person = results.participants[i];
    const std::vector<Level> fitted = fitted_levels(person, design);
    estimate(person, model, fitted, results.draws);
    if (results.has_posteriors) {
      add_posterior(person, model, fitted);
    }
  });
  results.mean_log = mean_of(results.participants);
  results.population = population_of(results.participants, design.shape);
  return results;
}
}  // namespace tapstudy::analysis
