#include "analysis/report/blocks/thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/detection/decision_model.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "analysis/statistics/resampling/replicates.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr double max_lapse = 0.1;
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

std::string level_words(const VariedAxis& axis) {
  const std::string side = axis.is_below ? "below" : "above";
  return axis.is_fraction ? fmt::format("{} {} the standard of {:.4g}, as a fraction of it",
                                        axis.name.with_unit(), side, axis.standard)
                          : fmt::format("{} {} the standard of {:.4g}", axis.name.with_unit(), side,
                                        axis.standard);
}

namespace {
// Empty: there is none.
std::string d_prime_words(const BlockDesign& design) {
  if (design.has_own_guess_rate) {
    return "d' at a level: same-different of a differencing observer, because levels change from "
           "trial to trial (Macmillan & Creelman 2005, ch. 9), by hits there and all false alarms, "
           "k + 1/2 in n + 1 (Hautus 1995).";
  }
  return design.decision_model.empty()
             ? ""
             : fmt::format("d' at a level by the decision model '{}' ({}).", design.decision_model,
                           find_decision_model(design.decision_model)->summary);
}

// Catch trials, at 0, aside.
bool is_beyond_levels(double threshold, const std::vector<Level>& levels) {
  const auto lowest =
      std::ranges::find_if(levels, [](const Level& one) { return one.value != 0.0; });
  return lowest != levels.end() && (threshold < lowest->value || threshold > levels.back().value);
}

std::vector<std::string> remarks_on_people(const std::vector<ParticipantThreshold>& people) {
  std::vector<std::string> remarks;
  for (const ParticipantThreshold& person : people) {
    if (!person.estimate) {
      remarks.push_back(
          fmt::format("{} has no threshold: {}.", person.participant_id, person.no_threshold));
    }
  }
  for (const ParticipantThreshold& person : people) {
    if (person.estimate && !person.no_posterior.empty()) {
      remarks.push_back(fmt::format("{} has a threshold but no posterior: {}.",
                                    person.participant_id, person.no_posterior));
    }
  }
  for (const ParticipantThreshold& person : people) {
    if (person.posterior && is_beyond_levels(person.posterior->threshold, person.levels)) {
      remarks.push_back(
          fmt::format("The median of {}'s posterior lies beyond the levels that were presented: it "
                      "rests on the prior.",
                      person.participant_id));
    }
  }
  if (std::ranges::any_of(people, [](const ParticipantThreshold& person) {
        return person.estimate && person.estimate->is_step;
      })) {
    remarks.emplace_back(
        "A slope that is only known to be above a limit: the answers change within one step "
        "between levels. The threshold is then the middle of those that are equally likely.");
  }
  return remarks;
}

std::vector<std::string> remarks_on_mean(const ThresholdResults& results) {
  if (!results.mean_log) {
    return {"No mean over participants: it takes two with a threshold."};
  }
  std::vector<std::string> remarks{
      "Mean over participants: of the logarithms of their thresholds, each counting the same, "
      "interval by t. The standard deviation is that between participants and of their "
      "estimates' errors together. Answers of participants are not put together as if of one."};
  if (results.population) {
    remarks.emplace_back(
        "Random-effects mean (Paule & Mandel 1982, interval of Hartung & Knapp 2001): each "
        "posterior "
        "counts as well as it is known; its standard deviation is that of participants alone.");
  }
  const int without =
      static_cast<int>(results.participants.size()) - results.mean_log->participants;
  if (without > 0) {
    remarks.push_back(fmt::format(
        "It leaves out {} without a threshold, which biases it.",
        without == 1 ? "the participant" : fmt::format("the {} participants", without)));
  }
  return remarks;
}
}  // namespace

std::vector<std::string> threshold_remarks(const BlockDesign& design,
                                           const ThresholdResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<std::string> remarks{
      "Levels: " + level_words(*design.axis) + ".",
      fmt::format("Thresholds: maximum likelihood of a {} function of the level, {}, lapse rate "
                  "from 0 to 0.1; intervals by profile likelihood. At the threshold the function "
                  "without guesses and lapses is at {:.0f} %.",
                  core::row_of(design.shape).name,
                  design.has_own_guess_rate
                      ? "guess rate free, with the false alarms as answers at the level 0"
                      : fmt::format("guess rate {:.3g} fixed", design.guess_rate),
                  100.0 * core::shape_value(design.shape, 1.0, 1.0, 1.0))};
  std::ranges::copy(remarks_on_people(results.participants), std::back_inserter(remarks));
  std::ranges::copy(remarks_on_mean(results), std::back_inserter(remarks));
  remarks.push_back(
      results.draws > 0
          ? fmt::format("Deviance test: {} parametric bootstrap draws; a small p says that the "
                        "function does not fit.",
                        results.draws)
          : "Deviance tests are not made for so many levels.");
  remarks.emplace_back(results.has_posteriors
                           ? "Posteriors: beta-binomial answers and the priors of Schütt et al. "
                             "2016, which limit the slope where the answers alone do not."
                           : "Posteriors are not computed for so many levels.");
  if (const std::string words = d_prime_words(design); !words.empty()) {
    remarks.push_back(words);
  }
  return remarks;
}

namespace {
MainResult mean_threshold(const VariedAxis& axis, const MeanLogThreshold& log_mean) {
  const auto from_log = [](double log) { return std::pow(10.0, log); };
  return {axis.is_fraction ? "Weber fraction of " + axis.name.quantity
                           : "just noticeable difference of " + axis.name.with_unit(),
          from_log(log_mean.mean),
          {from_log(log_mean.interval.low), from_log(log_mean.interval.high)},
          {},
          {},
          true};
}

// A threshold is where the function without guesses has a value that depends on its shape.
PersonalValues thresholds_of(const BlockDesign& design, const ThresholdResults& results) {
  const VariedAxis& axis = *design.axis;
  return personal_values(fmt::format("threshold of {}{}{}, {}, {} function", axis.name.with_unit(),
                                     axis.is_below ? " below the standard" : "",
                                     axis.is_fraction ? " (Weber fraction)" : "", design.task,
                                     core::row_of(design.shape).name),
                         true, results.participants, [](const ParticipantThreshold& person) {
                           return person.estimate ? std::optional{person.estimate->curve.threshold}
                                                  : std::nullopt;
                         });
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_thresholds(const BlockDesign& design,
                                                   const BlockRows& rows) {
  const ThresholdResults results = participant_thresholds(design, rows.answers);
  auto summary = std::make_shared<TabularSummary>(design);
  summary->parts = threshold_tables(design, results);
  if (!design.has_own_guess_rate) {  // there the false alarms are the bias
    summary->parts.push_back(answer_counts_table(rows.answers));
  }
  summary->charts = threshold_charts(design, results);
  summary->remarks = threshold_remarks(design, results);
  summary->personal = thresholds_of(design, results);
  if (results.mean_log) {
    summary->main = {mean_threshold(*design.axis, *results.mean_log)};
  }
  return summary;
}
}  // namespace tapstudy::analysis
