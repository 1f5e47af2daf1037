#include "analysis/thresholds/threshold_tables.hpp"

#include <cmath>
#include <map>

#include "analysis/blocks/pooled_proportion.hpp"
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
      interval_column("just noticeable difference of " + axis.name, "jnd")};
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

ReportTable participants_table(const VariedAxis& axis, const ThresholdResults& results) {
  ReportTable table{
      "participants",
      "Thresholds of the participants",
      {column("participant", "participant_id"), proportion_column("correct", "correct")}};
  const std::vector<Column> thresholds = threshold_columns(axis);
  table.columns.insert(table.columns.end(), thresholds.begin(), thresholds.end());
  const Column at = column("correct at threshold", "proportion_at_threshold");
  table.columns.push_back(at);
  table.columns.push_back(column("", "no_threshold_because"));
  for (const ParticipantThreshold& person : results.participants) {
    std::vector<Cell> row{word(person.participant_id), proportion(person.correct)};
    if (person.estimate) {
      add_threshold(row, axis, person.estimate->curve.threshold,
                    person.estimate->intervals.threshold);
      row.push_back(share(person.estimate->proportion_at_threshold));
    } else {
      for (const Column& of_threshold : thresholds) {
        row.push_back(nothing(of_threshold));
      }
      row.push_back(nothing(at));
    }
    row.push_back(person.estimate ? Cell{"", {Value{}}} : word(person.no_threshold));
    table.rows.push_back(row);
  }
  return table;
}

ReportTable pooled_table(const VariedAxis& axis, const ThresholdResults& results) {
  ReportTable table{"pooled",
                    "Over participants: random-effects mean of the logarithms of the thresholds",
                    {column("participants", "participants")}};
  for (const Column& of_threshold : threshold_columns(axis)) {
    table.columns.push_back(of_threshold);
  }
  table.columns.push_back(column("SD between, log10", "between_sd_log10"));
  table.columns.push_back(column("all alike", "heterogeneity_p"));
  if (results.pooled_log) {
    const PooledEstimate& mean = *results.pooled_log;
    std::vector<Cell> row{count(results.pooled_participants)};
    add_threshold(row, axis, std::pow(10.0, mean.mean),
                  {std::pow(10.0, mean.interval.low), std::pow(10.0, mean.interval.high)});
    row.push_back(number(std::sqrt(mean.between_variance)));
    row.push_back(probability(mean.heterogeneity_p));
    table.rows.push_back(row);
  }
  return table;
}

ReportTable fits_table(const ThresholdResults& results) {
  ReportTable table{
      "fits",
      "Fits: Weibull function of the level",
      {column("participant", "participant_id"), interval_column("slope (95 % CI)", "slope"),
       column("guess", "guess"), column("lapse", "lapse"), column("deviance test", "deviance_p"),
       interval_column("Bayesian threshold (95 %)", "posterior_threshold")}};
  for (const ParticipantThreshold& person : results.participants) {
    std::vector<Cell> row{word(person.participant_id)};
    if (const auto& of = person.estimate) {
      row.insert(row.end(),
                 {interval(of->curve.slope, of->intervals.slope), number(of->curve.guess),
                  number(of->curve.lapse, 2),
                  probability(of->goodness ? std::optional{of->goodness->p} : std::nullopt)});
    } else {
      for (std::size_t i = 1; i + 1 < table.columns.size(); ++i) {
        row.push_back(nothing(table.columns[i]));
      }
    }
    row.push_back(person.posterior
                      ? interval(person.posterior->threshold, person.posterior->threshold_interval)
                      : nothing(table.columns.back()));
    if (person.estimate || person.posterior) {
      table.rows.push_back(row);
    }
  }
  return table;
}

ReportTable levels_table(const ThresholdResults& results) {
  ReportTable table{"levels",
                    "Levels of each participant",
                    {column("participant", "participant_id"), column("level", "level"),
                     proportion_column("correct", "correct")}};
  table.is_for_programs = true;
  for (const ParticipantThreshold& person : results.participants) {
    for (const Level& level : person.levels) {
      table.rows.push_back(
          {word(person.participant_id), number(level.value), proportion(level.answers)});
    }
  }
  return table;
}

ReportTable levels_over_participants(const ThresholdResults& results) {
  ReportTable table{"levels_over_participants",
                    "Levels, answers of all participants together (not a fit)",
                    {column("level", "level"), column("participants", "participants"),
                     proportion_column("correct", "correct")}};
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
  return table;
}

ReportTable tracks_table(const ThresholdResults& results) {
  ReportTable table{"tracks",
                    "Levels in order of time",
                    {column("participant", "participant_id"), column("trial", "trial"),
                     column("level", "level"), column("correct", "is_correct")}};
  table.is_for_programs = true;
  for (const ParticipantThreshold& person : results.participants) {
    for (const TrackPoint& point : person.track) {
      table.rows.push_back({word(person.participant_id), count(point.number), number(point.level),
                            flag(point.is_correct)});
    }
  }
  return table;
}

ReportTable false_alarm_table(const ThresholdResults& results) {
  ReportTable table{
      "false_alarms",
      "Trials without a comparison: answered wrongly (false alarms)",
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
  return {participants_table(*design.axis, results),
          pooled_table(*design.axis, results),
          fits_table(results),
          levels_over_participants(results),
          false_alarm_table(results),
          levels_table(results),
          tracks_table(results)};
}
}  // namespace tapstudy::analysis
