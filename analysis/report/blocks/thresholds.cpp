#include "analysis/report/blocks/thresholds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/document/wording.hpp"
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
// Levels of all participants together for which deviances are drawn and priors are varied.
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
    person.outcome = fit.outcome;
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
                   const std::vector<Level>& levels, bool is_examined) {
  constexpr double confidence = 0.95;
  const auto with = [&](double breadth) {
    return psychometric_posterior(model, levels, confidence, breadth);
  };
  try {
    const PsychometricPosterior posterior = with(prior_breadth);
    person.posterior = posterior.estimates;
    const bool is_guess_free =
        model.guess.low < model.guess.high;  // which takes eight times longer
    if (posterior.estimates && is_examined && !is_guess_free) {
      person.narrower = with(0.5 * prior_breadth).estimates;
      person.broader = with(2.0 * prior_breadth).estimates;
    }
    person.no_posterior = posterior.estimates ? "" : explanation(posterior.outcome);
  } catch (const core::NotEstimable& error) {
    person.no_posterior = error.what();
  }
}

std::optional<PopulationFit> population_of(const std::vector<ParticipantThreshold>& people,
                                           const PsychometricModel& model,
                                           const BlockDesign& design) {
  std::vector<std::vector<Level>> levels;
  for (const ParticipantThreshold& person : people) {
    levels.push_back(fitted_levels(person, design));
  }
  try {
    return fit_population(model, levels);
  } catch (const core::NotEstimable&) {  // which each participant's fit says
    return std::nullopt;
  }
}

std::optional<MeanLogThreshold> mean_of(const std::vector<ParticipantThreshold>& people) {
  std::vector<double> logarithms;
  for (const ParticipantThreshold& person : people) {
    if (const auto threshold = likeliest_threshold(person); threshold && *threshold > 0.0) {
      logarithms.push_back(std::log10(*threshold));
    }
  }
  if (logarithms.size() < 2) {
    return std::nullopt;
  }
  const MeanAndSpread spread = mean_and_spread(logarithms);
  return MeanLogThreshold{spread.mean, spread.standard_deviation, t_interval(logarithms),
                          static_cast<int>(logarithms.size())};
}

}  // namespace

std::optional<ReportedThreshold> reported_threshold(const ParticipantThreshold& person) {
  if (const auto& of = person.posterior) {
    return ReportedThreshold{of->threshold, of->threshold_interval, true};
  }
  if (const auto& of = person.estimate) {
    return ReportedThreshold{of->curve.threshold, of->intervals.threshold, false};
  }
  return std::nullopt;
}

std::optional<double> likeliest_threshold(const ParticipantThreshold& person) {
  if (person.estimate) {
    return person.estimate->curve.threshold;
  }
  return person.posterior ? std::optional{person.posterior->threshold} : std::nullopt;
}

std::optional<Interval> beyond_levels(const ParticipantThreshold& person) {
  using enum FitOutcome;
  const auto presented =
      std::ranges::find_if(person.levels, [](const Level& one) { return one.value > 0.0; });
  if (reported_threshold(person) || !person.outcome || presented == person.levels.end()) {
    return std::nullopt;
  }
  switch (*person.outcome) {
    case all_successes:
    case threshold_below:
      return Interval{0.0, presented->value};
    case no_successes:
    case threshold_above:
      return Interval{person.levels.back().value, std::numeric_limits<double>::infinity()};
    case no_increase: {  // at the foot of the function or at its top
      constexpr double middle = 0.75;
      return person.correct.value() < middle
                 ? std::optional{Interval{person.levels.back().value,
                                          std::numeric_limits<double>::infinity()}}
                 : std::nullopt;
    }
    case fitted:
    case step:
      return std::nullopt;
  }
  return std::nullopt;
}

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
  const PsychometricModel model = model_of(design);
  if (levels <= most_levels_examined) {
    results.population = population_of(results.participants, model, design);
  }
  parallel_for(results.participants.size(), 0, [&](std::size_t i) {
    ParticipantThreshold& person = results.participants[i];
    const std::vector<Level> fitted = fitted_levels(person, design);
    estimate(person, model, fitted, results.draws);
    add_posterior(person, model, fitted, is_examined);
  });
  results.mean_log = mean_of(results.participants);
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
// Empty where no d' is computed.
CitingText describe_d_prime(const BlockDesign& design) {
  if (design.has_own_guess_rate) {
    return core::citing(
        "d' at a level: same-different of a differencing observer, because levels change from "
        "trial to trial ({}, ch. 9), by hits there and all false alarms, k + 1/2 in n + 1 ({}).",
        "Macmillan & Creelman 2005"_source, "Hautus 1995"_source);
  }
  return design.decision_model.empty()
             ? ""
             : fmt::format("d' at a level by the decision model '{}' ({}).", design.decision_model,
                           find_decision_model(design.decision_model)->summary);
}

CitingText words_of_prior(const ThresholdResults& results) {
  return core::citing(
      "Posteriors: beta-binomial answers; priors of the form of {}: the threshold even over the "
      "levels presented, which span R, falling to 0 at 1.5 R beyond them; the width of the "
      "function "
      "(from 5 to 95 %) even from two gaps of levels to 3 R, falling to 0 at 9 R; lapses beta(1, "
      "10). {} An upper end is infinite where the answers do not tell a threshold from guesses at "
      "every level (probability above .025, both as likely before).",
      "Schütt et al. 2016"_source,
      results.draws > 0
          ? "The table of priors has thresholds with half and twice these ranges: where they "
            "differ, the answers tell little."
          : "Thresholds with other priors are not computed for so many levels.");
}

// Catch trials, at 0, aside.
bool is_beyond_levels(double threshold, const std::vector<Level>& levels) {
  const auto lowest =
      std::ranges::find_if(levels, [](const Level& one) { return one.value != 0.0; });
  return lowest != levels.end() && (threshold < lowest->value || threshold > levels.back().value);
}

std::vector<CitingText> remarks_on_people(const std::vector<ParticipantThreshold>& people) {
  std::vector<CitingText> remarks;
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

CitingText words_of_population(const BlockDesign& design) {
  return core::citing(
      "Fit of all participants together: thresholds ({}) and logarithms of slopes are normal over "
      "participants, whose answers, also right or wrong at all levels, count as they are ({}); by "
      "marginal likelihood ({}), with lapses of each integrated out. Interval by profile "
      "likelihood, with the quantile of t. Each participant's threshold is drawn to the mean the "
      "more, the less the answers tell; its interval takes the population as known.",
      core::row_of(design.shape).is_logarithmic ? "their logarithms" : "as they are",
      "Moscatelli et al. 2012"_source, "Bock & Aitkin 1981"_source);
}

std::vector<CitingText> remarks_on_mean(const ThresholdResults& results) {
  if (!results.mean_log) {
    return {"No mean over participants: it takes two with a threshold."};
  }
  std::vector<CitingText> remarks{
      "Mean over participants: of the logarithms of their likeliest thresholds, each counting the "
      "same, interval by t; posterior medians of short tracks are too low on average. The standard "
      "deviation is that between participants and of their estimates' errors together. Answers of "
      "participants are not put together as if of one."};
  const int without =
      static_cast<int>(results.participants.size()) - results.mean_log->participants;
  if (without > 0) {
    remarks.push_back(
        fmt::format("It leaves out {} without a threshold, which biases it{}.",
                    without == 1 ? "the participant" : fmt::format("the {} participants", without),
                    results.population
                        ? "; the fit of all participants together does not"
                        : ". There is no fit of all participants together, whose mean would lie "
                          "beyond the levels, or who are too few or have too many levels; the "
                          "block's result is by a normal likelihood of the logarithms, with those "
                          "who lie beyond the levels as such, if it can be told"));
  }
  return remarks;
}
}  // namespace

std::vector<CitingText> threshold_remarks(const BlockDesign& design,
                                          const ThresholdResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks{
      "Levels: " + level_words(*design.axis) + ".",
      fmt::format("Thresholds: {} of a {} function of the level, {}, lapse rate "
                  "from 0 to 0.1. At the threshold the function "
                  "without guesses and lapses is at {:.0f} %.",
                  "posterior medians with 95 % credible intervals", core::row_of(design.shape).name,
                  design.has_own_guess_rate
                      ? "guess rate free, with the false alarms as answers at the level 0"
                      : fmt::format("guess rate {:.3g} fixed", design.guess_rate),
                  100.0 * core::shape_value(design.shape, 1.0, 1.0, 1.0))};
  std::ranges::copy(remarks_on_people(results.participants), std::back_inserter(remarks));
  std::ranges::copy(remarks_on_mean(results), std::back_inserter(remarks));
  if (results.population) {
    remarks.push_back(words_of_population(design));
  }
  remarks.push_back(
      results.draws > 0
          ? fmt::format("Deviance test: {} parametric bootstrap draws; a small p says that the "
                        "function does not fit.",
                        results.draws)
          : "Deviance tests are not made for so many levels.");
  remarks.push_back(words_of_prior(results));
  if (const CitingText words = describe_d_prime(design); !words.empty()) {
    remarks.push_back(words);
  }
  return remarks;
}

namespace {
// In place of a mean that would leave people out: of a normal distribution of the logarithms, of
// whom some are known to lie beyond the levels. Unset where its interval has an open end.
std::optional<MainResult> with_those_beyond(MainResult result, const ThresholdResults& results) {
  std::vector<Interval> logarithms;
  std::int64_t beyond = 0;
  for (const ParticipantThreshold& person : results.participants) {
    const auto threshold = likeliest_threshold(person);
    if (const auto range = beyond_levels(person)) {
      logarithms.push_back({std::log10(range->low), std::log10(range->high)});
      ++beyond;
    } else if (threshold && *threshold > 0.0) {
      logarithms.push_back({std::log10(*threshold), std::log10(*threshold)});
    }
  }
  constexpr double confidence = 0.95;
  const CensoredMean found = censored_mean(logarithms, confidence);
  if (!std::isfinite(found.interval.low) || !std::isfinite(found.interval.high)) {
    return std::nullopt;
  }
  result.estimate = from_log(found.mean);
  result.range = {from_log(found.interval.low), from_log(found.interval.high)};
  result.people = static_cast<int>(logarithms.size());
  result.of_whom = among_them(beyond, "beyond the levels");
  return result;
}

// Of the fit of all where the mean would leave somebody out.
std::optional<MainResult> mean_threshold(const VariedAxis& axis, const ThresholdResults& results) {
  MainResult mean;
  mean.name = axis.is_fraction ? "Weber fraction of " + axis.name.quantity
                               : "just noticeable difference of " + axis.name.with_unit();
  mean.is_ratio = true;
  if (const auto& of = results.population; of && results.leaves_out_people() &&
                                           of->threshold > 0.0 && of->interval.low > 0.0 &&
                                           std::isfinite(of->interval.high)) {
    mean.estimate = of->threshold;
    mean.range = of->interval;
    mean.people = static_cast<int>(results.participants.size());
    mean.of_whom = among_them(*mean.people - results.mean_log->participants,
                              "without a threshold of their own (one fit of all)");
    return mean;
  }
  if (!results.mean_log) {
    return std::nullopt;
  }
  if (results.leaves_out_people()) {
    return with_those_beyond(mean, results);
  }
  mean.estimate = from_log(results.mean_log->mean);
  mean.range = {from_log(results.mean_log->interval.low),
                from_log(results.mean_log->interval.high)};
  mean.people = results.mean_log->participants;
  return mean;
}

// A threshold is where the function without guesses has a value that depends on its shape.
PersonalValues thresholds_of(const BlockDesign& design, const ThresholdResults& results) {
  const VariedAxis& axis = *design.axis;
  PersonalValues values =
      personal_values(fmt::format("threshold of {}{}{}, {}, {} function", axis.name.with_unit(),
                                  axis.is_below ? " below the standard" : "",
                                  axis.is_fraction ? " (Weber fraction)" : "", design.task,
                                  core::row_of(design.shape).name),
                      true, results.participants, likeliest_threshold);
  for (const ParticipantThreshold& person : results.participants) {
    if (const auto range = beyond_levels(person)) {
      values.beyond[person.participant_id] = *range;
    }
  }
  return values;
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_thresholds(const BlockDesign& design,
                                                   const BlockRows& rows) {
  const ThresholdResults results = participant_thresholds(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = threshold_tables(design, results);
  if (!design.has_own_guess_rate) {  // there the false alarms are the bias
    summary->results().tables.push_back(answer_counts_table(rows.answers));
  }
  summary->results().charts = threshold_charts(design, results);
  summary->results().remarks = threshold_remarks(design, results);
  summary->personal = thresholds_of(design, results);
  if (const auto mean = mean_threshold(*design.axis, results)) {
    summary->main_results = {*mean};
    if (results.participants.size() > 1) {
      Chart& overview = summary->results().charts.front();
      overview.points.push_back({mean->estimate, 0.0, 1.0, true});
      overview.bars.push_back({0.0, mean->range.value()});
    }
  }
  return summary;
}
}  // namespace tapstudy::analysis
