#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/report/document/wording.hpp"
#include "analysis/statistics/detection/rates.hpp"
#include "analysis/statistics/psychometric/likelihood.hpp"
namespace tapstudy::analysis {
namespace {
// A level in the axis's own unit.
double in_unit(const VariedAxis& axis, double level) {
  return axis.is_fraction ? level * std::abs(axis.standard) : level;
}

Interval in_unit(const VariedAxis& axis, const Interval& levels) {
  return {in_unit(axis, levels.low), in_unit(axis, levels.high)};
}

std::vector<Column> threshold_columns(const VariedAxis& axis) {
  std::vector<Column> columns{
      interval_column(
          axis.is_fraction ? "threshold: Weber fraction (95 % CI)" : "threshold (95 % CI)",
          "threshold"),
      interval_column("just noticeable difference of " + axis.name.with_unit(), "jnd")};
  if (axis.is_fraction) {
    columns.push_back(interval_column("", "weber_fraction"));
  }
  return columns;
}

void add_threshold(std::vector<Cell>& row, const VariedAxis& axis, double threshold,
                   const Interval& range) {
  row.push_back(interval(threshold, range));
  row.push_back(interval(in_unit(axis, threshold), in_unit(axis, range)));
  if (axis.is_fraction) {
    row.push_back(interval(threshold, range));
  }
}

// Where participants may say that nothing differs, answers to trials in which something does.
Column answers_column(const BlockDesign& design) {
  return proportion_column(design.has_own_guess_rate ? "differences noticed (hits)" : "correct",
                           "correct");
}

ReportTable participants_table(const BlockDesign& design, const ThresholdResults& results) {
  const VariedAxis& axis = *design.axis;
  ReportTable table{"participants",
                    "Thresholds of the participants",
                    {column("participant", "participant_id"), answers_column(design)}};
  const std::vector<Column> thresholds = threshold_columns(axis);
  table.columns.insert(table.columns.end(), thresholds.begin(), thresholds.end());
  const Column at =
      column(design.has_own_guess_rate ? "noticed at threshold" : "correct at threshold",
             "proportion_at_threshold");
  table.columns.push_back(at);
  table.columns.push_back(column("", "no_threshold_because"));
  for (const ParticipantThreshold& person : results.participants) {
    std::vector<Cell> row{word(person.participant_id), proportion(person.correct)};
    if (const auto reported = reported_threshold(person)) {
      add_threshold(row, axis, reported->threshold, reported->interval);
      row.push_back(person.estimate ? share(person.estimate->proportion_at_threshold)
                                    : nothing(at));
    } else {
      for (const Column& of_threshold : thresholds) {
        row.push_back(nothing(of_threshold));
      }
      row.push_back(nothing(at));
    }
    row.push_back(reported_threshold(person) ? Cell{"", {Value{}}} : word(person.no_threshold));
    table.rows.push_back(row);
  }
  return table;
}

struct MeanThreshold {
  std::size_t participants{};
  double threshold{};
  Interval interval;
  double standard_deviation{};  // between participants, on the axis that the column names
};

ReportTable mean_table(const std::string& name, const std::string& title, const Column& deviation,
                       const VariedAxis& axis, const std::optional<MeanThreshold>& mean) {
  ReportTable table{name, title, {column("participants", "participants")}};
  for (const Column& of_threshold : threshold_columns(axis)) {
    table.columns.push_back(of_threshold);
  }
  table.columns.push_back(deviation);
  if (mean) {
    std::vector<Cell> row{count(static_cast<std::int64_t>(mean->participants))};
    add_threshold(row, axis, mean->threshold, mean->interval);
    row.push_back(number(mean->standard_deviation));
    table.rows.push_back(row);
  }
  return table;
}

ReportTable pooled_table(const VariedAxis& axis, const ThresholdResults& results) {
  std::optional<MeanThreshold> mean;
  if (const auto& of = results.mean_log) {
    mean = {static_cast<std::size_t>(of->participants),
            std::pow(10.0, of->mean),
            {std::pow(10.0, of->interval.low), std::pow(10.0, of->interval.high)},
            of->standard_deviation};
  }
  return mean_table("pooled",
                    results.leaves_out_people()
                        ? "Over participants with a threshold alone, which biases it: geometric "
                          "mean of the likeliest thresholds"
                        : "Over participants: geometric mean of the likeliest thresholds",
                    column("SD of log10 thresholds", "sd_log10"), axis, mean);
}

// Of all participants in one fit, whether they have a threshold of their own or not.
ReportTable population_table(const BlockDesign& design, const ThresholdResults& results) {
  std::optional<MeanThreshold> mean;
  if (const auto& of = results.population) {
    mean = {of->people.size(), of->threshold, of->interval, of->deviation};
  }
  const bool is_logarithmic = core::row_of(design.shape).is_logarithmic;
  return mean_table("population", "Over participants: one fit of all of them",
                    is_logarithmic ? column("SD between them of log10 thresholds", "sd_log10")
                                   : column("SD between them", "sd"),
                    *design.axis, mean);
}

ReportTable population_people_table(const ThresholdResults& results) {
  ReportTable table{"population_participants",
                    "Thresholds in the fit of all participants (95 %, the population as known)",
                    {column("participant", "participant_id"),
                     interval_column("threshold", "population_threshold")}};
  if (const auto& fit = results.population) {
    for (std::size_t i = 0; i < fit->people.size(); ++i) {
      table.rows.push_back({word(results.participants[i].participant_id),
                            interval(fit->people[i].threshold, fit->people[i].interval)});
    }
  }
  return table;
}

Cell slope_cell(const ThresholdEstimate& of) {
  return of.is_step ? Cell{fmt::format("above {}", rounded(of.intervals.slope.low)),
                           {Value{}, of.intervals.slope.low, of.intervals.slope.high}}
                    : interval(of.curve.slope, of.intervals.slope);
}

ReportTable fits_table(const BlockDesign& design, const ThresholdResults& results) {
  ReportTable table{
      "fits",
      fmt::format("Fits: {} function of the level", core::row_of(design.shape).name),
      {column("participant", "participant_id"),
       interval_column("likeliest threshold (95 % CI, profile)", "likeliest_threshold"),
       interval_column("slope (95 % CI)", "slope"), column("guess", "guess"),
       column("lapse", "lapse"), column("deviance test", "deviance_p")}};
  for (const ParticipantThreshold& person : results.participants) {
    if (const auto& of = person.estimate) {
      table.rows.push_back(
          {word(person.participant_id), interval(of->curve.threshold, of->intervals.threshold),
           slope_cell(*of), number(of->curve.guess), number(of->curve.lapse, 2),
           probability(of->goodness ? std::optional{of->goodness->p} : std::nullopt)});
    }
  }
  return table;
}

ReportTable posteriors_table(const ThresholdResults& results) {
  ReportTable table{
      "posteriors",
      "Posterior medians (95 % credible intervals)",
      {column("participant", "participant_id"), interval_column("threshold", "posterior_threshold"),
       interval_column("slope", "posterior_slope"), interval_column("lapse", "posterior_lapse"),
       interval_column("over-dispersion η", "over_dispersion"),
       interval_column("", "posterior_guess")}};
  const auto of = [](const Marginal& marginal) {
    return interval(marginal.median, marginal.credible);
  };
  for (const ParticipantThreshold& person : results.participants) {
    if (const auto& posterior = person.posterior) {
      table.rows.push_back({word(person.participant_id),
                            interval(posterior->threshold, posterior->threshold_interval),
                            interval(posterior->slope, posterior->slope_interval),
                            of(posterior->lapse), of(posterior->eta), of(posterior->guess)});
    }
  }
  return table;
}

// How much the thresholds rest on their prior.
ReportTable priors_table(const ThresholdResults& results) {
  ReportTable table{
      "priors",
      "Posterior thresholds with half and twice the breadth of the prior",
      {column("participant", "participant_id"), interval_column("half", "threshold_half_prior"),
       interval_column("as reported", "threshold_prior"),
       interval_column("twice", "threshold_twice_prior")}};
  for (const ParticipantThreshold& person : results.participants) {
    if (person.narrower && person.posterior && person.broader) {
      table.rows.push_back({word(person.participant_id)});
      for (const auto& of : {person.narrower, person.posterior, person.broader}) {
        table.rows.back().push_back(interval(of->threshold, of->threshold_interval));
      }
    }
  }
  return table;
}

constexpr std::int64_t fewest_answers = 5;  // corrected rates of fewer say little else

// d' of the answers at one level, if they are not too few; by hits and false alarms where
// participants set their own rate.
Cell d_prime_at(const Level& level, const ParticipantThreshold& person,
                const std::optional<DecisionTask>& task, bool has_own_guess_rate,
                const Column& of_d_prime) {
  if (level.answers.trials < fewest_answers) {
    return nothing(of_d_prime);
  }
  if (!has_own_guess_rate) {
    if (!task) {
      return nothing(of_d_prime);
    }
    const Sensitivity sensitive = sensitivity(*task, level.answers);
    return interval_above_zero(sensitive.d_prime, sensitive.interval);
  }
  if (person.false_alarms.trials == 0) {
    return nothing(of_d_prime);
  }
  const double d_prime = same_different_differencing(log_linear_rate(level.answers),
                                                     log_linear_rate(person.false_alarms))
                             .d_prime;
  const auto range = same_different_differencing_interval(level.answers, person.false_alarms);
  return range ? interval_above_zero(d_prime, *range) : interval(d_prime, range);
}

// Of procedures that jump from level to level programs see it only.
ReportTable levels_table(const BlockDesign& design, const ThresholdResults& results) {
  ReportTable table{"levels",
                    "Levels of each participant",
                    {column("participant", "participant_id"), column("level", "level"),
                     answers_column(design), interval_column("d' (95 % CI)", "d_prime")}};
  const auto task = design.has_own_guess_rate ? std::nullopt : decision_task(design);
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      table.rows.push_back(
          {word(person.participant_id), number(level.value), proportion(level.answers),
           d_prime_at(level, person, task, design.has_own_guess_rate, table.columns.back())});
    }
  }
  constexpr std::size_t most_rows_to_read = 60;
  table.shown_in = table.rows.size() > most_rows_to_read ? programs_only : ShownIn{};
  return table;
}

ReportTable levels_over_participants(const BlockDesign& design, const ThresholdResults& results) {
  ReportTable table{
      "levels_over_participants",
      "Levels, answers of all participants together (not a fit)",
      {column("level", "level"), column("participants", "participants"), answers_column(design)}};
  std::map<double, std::vector<Proportion>> answers;
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      answers[level.value].push_back(level.answers);
    }
  }
  for (const auto& [level, correct] : answers) {
    table.rows.push_back({number(level), count(static_cast<std::int64_t>(correct.size())),
                          pooled_proportion(correct)});
  }
  constexpr std::size_t most_rows_to_read =
      20;  // of adaptive procedures: most with an answer or two
  table.shown_in = table.rows.size() > most_rows_to_read ? programs_only : ShownIn{};
  return table;
}

ReportTable tracks_of(const ThresholdResults& results) {
  ReportTable table = tracks_table("correct", "is_correct");
  for (const ParticipantThreshold& person : results.participants) {
    add_track_rows(person.participant_id, person.track, table);
  }
  return table;
}

ReportTable false_alarm_table(const ThresholdResults& results) {
  ReportTable table{
      "false_alarms",
      "Trials in which nothing differs: answered that there is a difference (false alarms)",
      {column("participant", "participant_id"), proportion_column("false alarms", "false_alarms")}};
  for (const ParticipantThreshold& person : results.participants) {
    if (person.false_alarms.trials > 0) {
      table.rows.push_back({word(person.participant_id), proportion(person.false_alarms)});
    }
  }
  return table;
}
}  // namespace

std::vector<ReportTable> threshold_tables(const BlockDesign& design,
                                          const ThresholdResults& results) {
  // the first is the block's result where the second leaves somebody out
  std::vector<ReportTable> over{pooled_table(*design.axis, results),
                                population_table(design, results)};
  if (results.leaves_out_people()) {
    std::ranges::reverse(over);
  }
  return {participants_table(design, results),
          over[0],
          over[1],
          population_people_table(results),
          fits_table(design, results),
          posteriors_table(results),
          priors_table(results),
          levels_over_participants(design, results),
          false_alarm_table(results),
          levels_table(design, results),
          tracks_of(results)};
}

namespace {
std::vector<double> levels_of(const ThresholdResults& results) {
  std::vector<double> levels;
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      levels.push_back(level.value);
    }
  }
  return levels;
}

Chart function_chart(const ParticipantThreshold& person, const BlockDesign& design,
                     const Interval& range, bool is_logarithmic) {
  Chart chart{fmt::format("{}: correct at each level, areas by trials; curve: fit; bar: "
                          "threshold, 95 %; dashed: guessing",
                          person.participant_id),
              "",
              "level",
              "correct",
              range,
              {0.0, 1.0},
              is_logarithmic};
  chart.points = level_points(person.levels);
  if (!design.has_own_guess_rate) {
    chart.levels = {design.guess_rate};
  } else if (person.estimate) {
    chart.levels = {person.estimate->curve.guess};
  }
  chart.alternative = fmt::format("Psychometric function of {}: {} correct of {} at {} levels, ",
                                  person.participant_id, person.correct.successes,
                                  person.correct.trials, person.levels.size());
  if (!person.estimate) {
    chart.alternative += "no threshold";
    return chart;
  }
  chart.line = curve_points(chart, design.shape, person.estimate->curve);
  const auto reported = reported_threshold(person);
  chart.bars = {{person.estimate->proportion_at_threshold, reported->interval}};
  chart.alternative += "threshold " + with_interval(reported->threshold, reported->interval);
  return chart;
}

// Over a logarithmic axis the area below the curve is 1 per decade.
Chart posterior_chart(const ParticipantThreshold& person, const PosteriorEstimates& posterior,
                      core::PsychometricShape shape, const Interval& range) {
  const Marginal& marginal = posterior.position;
  const double most = *std::ranges::max_element(marginal.density);
  const bool is_logarithmic = core::row_of(shape).is_logarithmic;
  Chart chart{
      fmt::format("{}: posterior of the threshold, with its 95 % credible interval",
                  person.participant_id),
      fmt::format("Posterior density of the threshold of {}, median {}", person.participant_id,
                  with_interval(posterior.threshold, posterior.threshold_interval)),
      "threshold",
      is_logarithmic ? "density per decade" : "density",
      range,
      {0.0, 1.05 * most},
      is_logarithmic};
  for (std::size_t i = 0; i < marginal.at.size(); ++i) {
    const double threshold = from_axis(shape, marginal.at[i]);
    if (threshold >= range.low && threshold <= range.high) {
      chart.line.push_back({threshold, marginal.density[i]});
    }
  }
  chart.bars = {{0.02 * most, posterior.threshold_interval}};
  return chart;
}

// From the lowest to the highest threshold that is not negligible.
Interval range_of_posteriors(const ThresholdResults& results, core::PsychometricShape shape) {
  constexpr double negligible = 1e-3;
  std::vector<double> thresholds;
  for (const ParticipantThreshold& person : results.participants) {
    if (person.posterior) {
      const Marginal& marginal = person.posterior->position;
      const double most = *std::ranges::max_element(marginal.density);
      for (std::size_t i = 0; i < marginal.at.size(); ++i) {
        if (marginal.density[i] > negligible * most) {
          thresholds.push_back(from_axis(shape, marginal.at[i]));
        }
      }
    }
  }
  return thresholds.empty() ? Interval{} : range_of(thresholds, core::row_of(shape).is_logarithmic);
}
// A row a participant, from below; the lowest is left for the block's result.
Chart overview_chart(const ThresholdResults& results, std::vector<double> places,
                     bool is_logarithmic) {
  constexpr double most_area = 0.4;
  const auto people = static_cast<double>(results.participants.size());
  Chart chart{"Thresholds, 95 %, of participants 1 to " + fmt::format("{}", people) +
                  ", in the order of the table; a bar alone: beyond the levels; at 0, open: over "
                  "participants",
              "",
              "threshold",
              "participant",
              {},
              {-0.5, people + 0.5},
              is_logarithmic};
  chart.name = "thresholds";
  double row = 0.0;
  for (const ParticipantThreshold& person : results.participants) {
    row += 1.0;
    const auto reported = reported_threshold(person);
    if (reported && (!is_logarithmic || reported->threshold > 0.0)) {
      chart.points.push_back({reported->threshold, row, std::min(most_area, 8.0 / people)});
      chart.bars.push_back({row, reported->interval});
      places.push_back(reported->threshold);
    } else if (const auto beyond = beyond_levels(person)) {
      chart.bars.push_back({row, *beyond});
    }
  }
  chart.alternative = fmt::format("Thresholds of {} participants, {} of whom lie beyond the levels",
                                  people, chart.bars.size() - chart.points.size());
  chart.x_range = range_of(places, is_logarithmic);
  return chart;
}
}  // namespace

std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results) {
  const std::vector<double> levels = levels_of(results);
  const bool is_logarithmic = std::ranges::all_of(levels, [](double level) { return level > 0.0; });
  const Interval range = range_of(levels, is_logarithmic);
  const Interval thresholds = range_of_posteriors(results, design.shape);
  std::vector<Chart> charts;
  if (results.participants.size() > 1) {
    charts.push_back(overview_chart(results, levels, is_logarithmic));
  }
  for (const ParticipantThreshold& person : results.participants) {
    if (!person.track.empty()) {
      charts.push_back(function_chart(person, design, range, is_logarithmic));
      charts.back().begins_row = true;
      for (Chart& chart :
           track_charts(person.participant_id, person.track, range, is_logarithmic, "wrong")) {
        charts.push_back(std::move(chart));
      }
      if (person.posterior) {
        charts.push_back(posterior_chart(person, *person.posterior, design.shape, thresholds));
      }
    }
  }
  return charts;
}
}  // namespace tapstudy::analysis
