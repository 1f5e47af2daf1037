#include "analysis/report/blocks/equality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/report/blocks/psychometric_levels.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/distributions.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
namespace {
using results::AlternativeRow;
using results::AnswerRow;
constexpr double max_rate = 0.1;
constexpr std::uint64_t test_seed = 1;

bool is_judged_greater(const BlockDesign& design, const AnswerRow& answer) {
  const auto named =
      std::ranges::find(answer.alternatives, answer.response, &AlternativeRow::label);
  if (named == answer.alternatives.end()) {
    throw core::InvalidInput{
        fmt::format("block '{}': '{}', the answer of {} to trial {}, names no "
                    "alternative",
                    design.name, answer.response, answer.participant_id, answer.number)};
  }
  return named->is_comparison != design.axis->is_smaller_asked;
}

// Half of the distance from F = 0.25 to F = 0.75 at this slope, which scales it.
double jnd_at(core::PsychometricShape shape, double slope) {
  return std::isinf(slope) ? 0.0
                           : 0.5 * (core::shape_quantile(shape, 0.75, 0.0, slope) -
                                    core::shape_quantile(shape, 0.25, 0.0, slope));
}

void estimate(ParticipantEquality& person, const BlockDesign& design) {
  const PsychometricModel model = equality_model(design);
  try {
    const PsychometricFit fit = fit_psychometric(model, person.levels);
    const auto curve = curve_with_threshold(model, person.levels, fit);
    if (!curve) {
      person.no_estimate = explanation(fit.outcome);
      return;
    }
    const PsychometricIntervals intervals = profile_intervals(model, person.levels);
    person.estimate = {
        *curve,
        intervals.threshold,
        fit.curve ? std::optional{jnd_at(model.shape, fit.curve->slope)} : std::nullopt,
        {jnd_at(model.shape, intervals.slope.high), intervals.slope.low > 0.0
                                                        ? jnd_at(model.shape, intervals.slope.low)
                                                        : std::numeric_limits<double>::infinity()},
        std::nullopt};
    if (!design.is_for_main_results) {
      person.estimate->goodness = deviance_test(model, person.levels, draws_of_fit, test_seed);
    }
  } catch (const core::NotEstimable& error) {  // too few levels
    person.no_estimate = error.what();
  }
}

void add_means(EqualityResults& results) {
  std::vector<double> equalities;
  std::vector<double> log_jnds;
  for (const ParticipantEquality& person : results.participants) {
    if (person.estimate) {
      equalities.push_back(person.estimate->curve.threshold);
      if (person.estimate->jnd) {
        log_jnds.push_back(std::log10(*person.estimate->jnd));
      }
    }
  }
  if (equalities.size() > 1) {
    results.equality = paired_contrast(equalities, test_seed);
  }
  if (log_jnds.size() > 1) {
    results.log_jnd = paired_contrast(log_jnds, test_seed);
  }
}
}  // namespace

PsychometricModel equality_model(const BlockDesign& design) {
  return {design.shape, {0.0, max_rate}, {0.0, max_rate}, Rates::equal};
}

EqualityResults equality_results(const BlockDesign& design, const std::vector<AnswerRow>& answers) {
  if (!design.axis) {
    throw core::InvalidInput{fmt::format("block '{}': has no axis", design.name)};
  }
  std::map<std::string, ParticipantEquality> people;
  for (const AnswerRow& answer : answers) {
    ParticipantEquality& person = people[answer.participant_id];
    person.participant_id = answer.participant_id;
    if (const auto level = comparison_level(design, answer)) {
      const bool is_greater = is_judged_greater(design, answer);
      count_at(person.levels, *level, is_greater);
      add_track_point(person.track, answer, *level, is_greater);
    }
  }
  EqualityResults results;
  for (auto& [name, person] : people) {
    estimate(person, design);
    results.participants.push_back(std::move(person));
  }
  add_means(results);
  return results;
}

namespace {
double value_at(const VariedAxis& axis, double level) {
  return axis.standard + (axis.is_fraction ? level * axis.standard : level);
}
Interval values_at(const VariedAxis& axis, const Interval& levels) {
  return {value_at(axis, levels.low), value_at(axis, levels.high)};
}

std::vector<Column> estimate_columns() {
  return {interval_column("PSE (95 % CI)", "equality"),
          interval_column("constant error", "constant_error"), interval_column("JND", "jnd")};
}

ReportTable participants_table(const VariedAxis& axis, const EqualityResults& results) {
  ReportTable table{
      "participants",
      fmt::format("Points of subjective equality (PSE, {}), constant errors and just "
                  "noticeable differences (JND){}",
                  axis.name.with_unit(), axis.is_fraction ? " as fractions of the standard" : ""),
      {column("participant", "participant_id")}};
  std::ranges::copy(estimate_columns(), std::back_inserter(table.columns));
  table.columns.push_back(column("deviance test", "deviance_p"));
  for (const ParticipantEquality& person : results.participants) {
    std::vector<Cell> row{word(person.participant_id)};
    if (const auto& of = person.estimate) {
      row.push_back(interval(value_at(axis, of->curve.threshold), values_at(axis, of->equality)));
      row.push_back(interval(of->curve.threshold, of->equality));
      row.push_back(of->jnd ? interval(*of->jnd, of->jnd_interval)
                            : Cell{fmt::format("below {}", rounded(of->jnd_interval.high)),
                                   {Value{}, 0.0, of->jnd_interval.high}});
      row.push_back(probability(of->goodness ? std::optional{of->goodness->p} : std::nullopt));
    } else {
      std::ranges::transform(estimate_columns(), std::back_inserter(row),
                             [](const Column& missing) { return nothing(missing); });
      row.push_back(nothing(table.columns.back()));
    }
    table.rows.push_back(row);
  }
  return table;
}

ReportTable over_participants_table(const BlockDesign& design, const EqualityResults& results) {
  const VariedAxis& axis = *design.axis;
  ReportTable table{"over_participants",
                    "Over participants: mean of the PSEs, geometric mean of the JNDs",
                    {column("participants", "participants")}};
  std::ranges::copy(estimate_columns(), std::back_inserter(table.columns));
  table.columns.push_back(column("no constant error", "p"));
  if (results.equality) {
    const auto map = [](const std::optional<Interval>& range, auto to) {
      return range ? std::optional{Interval{to(range->low), to(range->high)}} : std::nullopt;
    };
    const auto to_value = [&](double level) { return value_at(axis, level); };
    const PairedContrast& equality = *results.equality;
    table.rows.push_back(
        {count(equality.participants),
         interval(to_value(equality.mean), map(equality.interval, to_value)),
         interval(equality.mean, equality.interval),
         results.log_jnd
             ? interval(from_log(results.log_jnd->mean), map(results.log_jnd->interval, from_log))
             : nothing(table.columns[3]),
         probability(design.premise.empty() ? std::optional{equality.p} : std::nullopt)});
  }
  return table;
}

ReportTable levels_table(const VariedAxis& axis, const EqualityResults& results) {
  ReportTable table{"levels",
                    "Comparisons that were judged greater",
                    {column("participant", "participant_id"), column("level", "level"),
                     column(axis.name.with_unit(), "value"),
                     proportion_column("judged greater", "judged_greater")}};
  table.shown_in = programs_only;
  for (const ParticipantEquality& person : results.participants) {
    for (const Level& level : person.levels) {
      table.rows.push_back({word(person.participant_id), number(level.value, 9),
                            number(value_at(axis, level.value), 9), proportion(level.answers)});
    }
  }
  return table;
}

ReportTable tracks_of(const EqualityResults& results) {
  ReportTable table = tracks_table("judged greater", "is_judged_greater");
  for (const ParticipantEquality& person : results.participants) {
    add_track_rows(person.participant_id, person.track, table);
  }
  return table;
}

std::vector<CitingText> remarks_on(const BlockDesign& design, const EqualityResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  std::vector<CitingText> remarks{
      fmt::format("The standard is {:.6g}. A {} function of how often the comparison is judged "
                  "greater, by maximum likelihood, with one rate of lapses from 0 to 0.1 at "
                  "both ends; intervals by profile likelihood. At equality it is at 50 %; the just "
                  "noticeable difference is half of the distance from 25 to 75 %, without lapses "
                  "(of participants who never lapse it comes out about a tenth too small: chance "
                  "errors far from the standard count as lapses). "
                  "Deviance test by parametric bootstrap: a small p says that it does not fit.",
                  design.axis->standard, core::row_of(design.shape).name)};
  for (const ParticipantEquality& person : results.participants) {
    if (!person.estimate) {
      remarks.push_back(fmt::format("{} has no point of equality: {}.", person.participant_id,
                                    person.no_estimate));
    }
  }
  const auto steps = std::ranges::count_if(results.participants, [](const auto& person) {
    return person.estimate && !person.estimate->jnd;
  });
  if (steps > 0) {
    remarks.push_back(fmt::format(
        "Answers of {} change within one step between levels: their PSE is the middle of those "
        "that are equally likely, their JND has no lower limit, and the mean JND leaves them out, "
        "which makes it too large.",
        steps == 1 ? "one participant" : fmt::format("{} participants", steps)));
  }
  if (!results.equality) {
    remarks.emplace_back("No mean over participants: it takes two with a point of equality.");
  } else {
    remarks.push_back(
        design.premise.empty()
            ? "Means over participants with intervals by Student's t; p: two-sided, by exchanging "
              "the signs of the participants' constant errors."
            : "Means over participants with intervals by Student's t. Not tested: " +
                  design.premise + ".");
  }
  return remarks;
}

Chart chart_of(const ParticipantEquality& person, const Interval& range,
               core::PsychometricShape shape) {
  Chart chart{fmt::format("{}: comparison judged greater; areas by trials", person.participant_id),
              fmt::format("Psychometric function of {}", person.participant_id),
              "level, 0: the standard",
              "judged greater",
              range,
              {0.0, 1.0}};
  chart.points = level_points(person.levels);
  chart.levels = {0.5};
  if (!person.estimate) {
    return chart;
  }
  const PsychometricCurve& curve = person.estimate->curve;
  chart.line = curve_points(chart, shape, curve);
  chart.bars = {{0.5 * (1.0 + curve.guess - curve.lapse), person.estimate->equality}};
  chart.alternative +=
      ", equality at the level " + with_interval(curve.threshold, person.estimate->equality);
  return chart;
}

std::vector<Chart> charts_of(const EqualityResults& results, core::PsychometricShape shape) {
  std::vector<double> levels;
  for (const ParticipantEquality& person : results.participants) {
    std::ranges::transform(person.levels, std::back_inserter(levels), &Level::value);
  }
  std::vector<Chart> charts;
  for (const ParticipantEquality& person : results.participants) {
    if (!person.levels.empty()) {
      const Interval range = range_of(levels, false);
      charts.push_back(chart_of(person, range, shape));
      charts.back().begins_row = true;
      for (Chart& chart :
           track_charts(person.participant_id, person.track, range, false, "not judged greater")) {
        charts.push_back(std::move(chart));
      }
    }
  }
  return charts;
}

PersonalValues points_of_equality(const VariedAxis& axis, const EqualityResults& results) {
  return personal_values(
      "point of subjective equality, " + axis.name.with_unit(), false, results.participants,
      [&](const ParticipantEquality& person) {
        return person.estimate ? std::optional{value_at(axis, person.estimate->curve.threshold)}
                               : std::nullopt;
      });
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_equality(const BlockDesign& design, const BlockRows& rows) {
  const EqualityResults results = equality_results(design, rows.answers);
  const VariedAxis& axis = *design.axis;
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {participants_table(axis, results),
                               over_participants_table(design, results),
                               levels_table(axis, results), tracks_of(results)};
  summary->results().charts = charts_of(results, design.shape);
  summary->results().remarks = remarks_on(design, results);
  if (design.premise.empty()) {
    summary->personal = points_of_equality(axis, results);
  }
  if (results.equality && results.equality->interval) {
    summary->main_results = {
        {"point of subjective equality, " + axis.name.with_unit(),
         value_at(axis, results.equality->mean),
         values_at(axis, *results.equality->interval),
         design.premise.empty() ? std::optional{results.equality->p} : std::nullopt,
         {},
         false,
         results.equality->participants}};
  }
  return summary;
}
}  // namespace tapstudy::analysis
