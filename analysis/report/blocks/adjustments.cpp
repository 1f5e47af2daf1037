#include "analysis/report/blocks/adjustments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/report/document/sections.hpp"
#include "analysis/statistics/population/means.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr std::uint64_t seed = 1;  // of draws, the same in every report
constexpr int bootstrap_draws = 4999;

double to_scale(const AdjustedAxis& axis, double value) {
  return axis.is_logarithmic ? std::log(value) : value;
}
double from_scale(const AdjustedAxis& axis, double value) {
  return axis.is_logarithmic ? std::exp(value) : value;
}

double adjusted_value(const BlockDesign& design, const AnswerRow& answer) {
  const auto value = core::number_in<double>(answer.response);
  const bool is_number = value && std::isfinite(*value);
  if (!is_number || (design.adjusted->is_logarithmic && *value <= 0.0)) {
    throw core::InvalidInput{fmt::format("block '{}', {} in trial {}: '{}' is not a value of {}",
                                         design.name, answer.participant_id, answer.number,
                                         answer.response, design.adjusted->name.key)};
  }
  return *value;
}

// The mean, on the axis's scale, of the settings of which this is so.
template <class Which>
std::optional<double> mean_where(const AdjustedAxis& axis, const std::vector<Setting>& settings,
                                 Which which) {
  std::vector<double> values;
  for (const Setting& setting : settings) {
    if (which(setting)) {
      values.push_back(to_scale(axis, setting.value));
    }
  }
  return values.empty() ? std::nullopt : std::optional{mean_and_spread(values).mean};
}

ParticipantSettings participant_of(const AdjustedAxis& axis, const std::string& name,
                                   const std::vector<Setting>& settings) {
  std::vector<double> values;
  std::ranges::transform(settings, std::back_inserter(values),
                         [&](const Setting& setting) { return to_scale(axis, setting.value); });
  const MeanAndSpread spread = mean_and_spread(values);
  const auto back = [&](const std::optional<double>& value) {
    return value ? std::optional{from_scale(axis, *value)} : std::nullopt;
  };
  ParticipantSettings person{name, settings, from_scale(axis, spread.mean),
                             spread.standard_deviation};
  if (axis.standard) {
    person.error = from_scale(axis, spread.mean - to_scale(axis, *axis.standard));
  }
  person.ascending =
      back(mean_where(axis, settings, [&](const Setting& one) { return one.start < axis.middle; }));
  person.descending =
      back(mean_where(axis, settings, [&](const Setting& one) { return one.start > axis.middle; }));
  return person;
}

using IntervalOfMean = Interval (*)(const std::vector<double>&);

template <class Back>
std::optional<MeanOfSettings> mean_of(const std::vector<double>& values, Back back,
                                      IntervalOfMean interval_of = t_interval) {
  if (values.empty()) {
    return std::nullopt;
  }
  const auto both = [&](const Interval& interval) {
    return Interval{back(interval.low), back(interval.high)};
  };
  MeanOfSettings result{
      back(mean_and_spread(values).mean), {}, {}, static_cast<int>(values.size())};
  if (values.size() > 1) {
    result.interval = both(interval_of(values));
    if (const auto bootstrap = bootstrap_interval(values, bootstrap_draws, seed)) {
      result.bootstrap = both(*bootstrap);
    }
  }
  return result;
}

// One value a participant, on the axis's scale.
struct Columns {
  std::vector<double> means;
  std::vector<double> errors;
  std::vector<double> deviations;
  std::vector<double> differences;
};

Columns columns_of(const AdjustedAxis& axis, const std::vector<ParticipantSettings>& people) {
  Columns columns;
  for (const ParticipantSettings& person : people) {
    columns.means.push_back(to_scale(axis, person.mean));
    if (axis.standard) {
      columns.errors.push_back(columns.means.back() - to_scale(axis, *axis.standard));
    }
    if (std::isfinite(person.standard_deviation)) {
      columns.deviations.push_back(person.standard_deviation);
    }
    if (person.ascending && person.descending) {
      columns.differences.push_back(to_scale(axis, *person.ascending) -
                                    to_scale(axis, *person.descending));
    }
  }
  return columns;
}

// Whether the axis may be taken for one that has nothing below 0.
bool is_positive(const AdjustedAxis& axis, const std::vector<ParticipantSettings>& people) {
  const auto is_below_zero = [](const Setting& one) { return one.start < 0.0 || one.value < 0.0; };
  return !axis.is_logarithmic && std::ranges::none_of(people, [&](const ParticipantSettings& one) {
    return std::ranges::any_of(one.settings, is_below_zero);
  });
}

std::optional<SignFlipTest> test_of(const std::vector<double>& differences) {
  return differences.size() > 1 ? std::optional{sign_flip_test(differences, seed)} : std::nullopt;
}
}  // namespace

AdjustmentResults adjustment_results(const BlockDesign& design,
                                     const std::vector<AnswerRow>& answers) {
  if (!design.adjusted) {
    throw core::InvalidInput{fmt::format("block '{}': no axis is adjusted", design.name)};
  }
  const AdjustedAxis& axis = *design.adjusted;
  std::map<std::string, std::vector<Setting>> people;
  for (const AnswerRow& answer : answers) {
    people[answer.participant_id].push_back(
        {answer.first_setting.value_or(std::numeric_limits<double>::quiet_NaN()),
         adjusted_value(design, answer)});
  }
  AdjustmentResults results;
  for (const auto& [name, settings] : people) {
    results.participants.push_back(participant_of(axis, name, settings));
  }
  const Columns columns = columns_of(axis, results.participants);
  const auto back = [&](double value) { return from_scale(axis, value); };
  results.equality =
      mean_of(columns.means, back,
              is_positive(axis, results.participants) ? positive_interval : t_interval);
  results.error = mean_of(columns.errors, back);
  results.deviation = mean_of(
      columns.deviations, [](double value) { return value; }, positive_interval);
  results.hysteresis = mean_of(columns.differences, back);
  if (design.premise.empty()) {
    results.error_test = test_of(columns.errors);
    results.hysteresis_test = test_of(columns.differences);
  }
  return results;
}

namespace {
// What is estimated over participants, a row each.
struct Estimate {
  std::string name;
  std::string unit;
  const std::optional<MeanOfSettings>& of;
  const std::optional<SignFlipTest>& test;
};

std::vector<Estimate> estimates_of(const AdjustedAxis& axis, const AdjustmentResults& results) {
  static const std::optional<SignFlipTest> none;
  const bool is_log = axis.is_logarithmic;
  const std::string& unit = axis.name.unit.empty() ? axis.name.quantity : axis.name.unit;
  return {{"point of subjective equality", unit, results.equality, none},
          {is_log ? "constant error (over the standard)" : "constant error",
           is_log ? "ratio" : unit, results.error, results.error_test},
          {is_log ? "standard deviation of logarithms" : "standard deviation",
           is_log ? "natural logarithm" : unit, results.deviation, none},
          {is_log ? "ascending over descending runs" : "ascending less descending runs",
           is_log ? "ratio" : unit, results.hysteresis, results.hysteresis_test}};
}

ReportTable estimates_table(const AdjustedAxis& axis, const AdjustmentResults& results) {
  ReportTable table{
      "over_participants",
      "Over participants",
      {column("estimate", "estimate"), column("in", "unit"),
       interval_column("mean (95 % CI)", "mean"), interval_column("by bootstrap", "bootstrap_mean"),
       column("participants", "participants"), column("p", "p")}};
  for (const Estimate& row : estimates_of(axis, results)) {
    if (!row.of) {
      continue;
    }
    const auto& drawn = row.of->bootstrap;
    table.rows.push_back({word(row.name), word(row.unit), interval(row.of->mean, row.of->interval),
                          drawn ? interval(row.of->mean, *drawn) : nothing(table.columns[3]),
                          count(row.of->participants),
                          probability(row.test ? std::optional{row.test->p} : std::nullopt)});
  }
  return table;
}

ReportTable participants_table(const AdjustedAxis& axis, const AdjustmentResults& results) {
  ReportTable table{
      "participants",
      fmt::format("Participants: {} that feels equal", axis.name.with_unit()),
      {column("participant", "participant_id"), column("settings", "settings"),
       column(axis.is_logarithmic ? "geometric mean" : "mean", "mean"),
       column(axis.is_logarithmic ? "over the standard" : "constant error", "constant_error"),
       column(axis.is_logarithmic ? "SD of ln" : "SD", "standard_deviation"),
       column("ascending", "ascending"), column("descending", "descending")}};
  for (const ParticipantSettings& person : results.participants) {
    table.rows.push_back(
        {word(person.participant_id), count(static_cast<std::int64_t>(person.settings.size())),
         number(person.mean), number(person.error), number(person.standard_deviation),
         number(person.ascending), number(person.descending)});
  }
  return table;
}

ReportTable settings_table(const AdjustmentResults& results) {
  ReportTable table{"settings",
                    "All settings",
                    {column("participant", "participant_id"), column("start", "start"),
                     column("setting", "setting")}};
  table.shown_in = programs_only;
  for (const ParticipantSettings& person : results.participants) {
    for (const Setting& setting : person.settings) {
      table.rows.push_back(
          {word(person.participant_id), number(setting.start, 9), number(setting.value, 9)});
    }
  }
  return table;
}

std::vector<CitingText> remarks_on(const BlockDesign& design, const AdjustmentResults& results) {
  if (results.participants.empty()) {
    return {"There are no answers."};
  }
  const AdjustedAxis& axis = *design.adjusted;
  std::vector<CitingText> remarks{fmt::format(
      "Each participant counts as the {} of the settings; intervals over participants{}, by t; of "
      "what is never below 0 up to the score with a variance in proportion to the mean. The "
      "standard deviation of a participant's settings estimates the difference threshold{}.",
      axis.is_logarithmic ? "geometric mean" : "mean",
      axis.is_logarithmic ? ", whose means are geometric too" : "",
      axis.is_logarithmic ? ", as a share: it is of natural logarithms" : "")};
  remarks.push_back(axis.standard
                        ? fmt::format("The standard is {:.6g}.", *axis.standard)
                        : "There is no constant error: the standard has no value on the axis.");
  remarks.push_back(
      fmt::format("Ascending runs started below {:.6g}, descending runs above.", axis.middle));
  remarks.push_back(design.premise.empty()
                        ? "p: two-sided, by exchanging the signs of the participants' differences."
                        : "Not tested: " + design.premise);
  return remarks;
}

std::optional<Chart> chart_of(const AdjustedAxis& axis, const AdjustmentResults& results) {
  if (!results.equality) {
    return std::nullopt;
  }
  Chart chart;
  std::vector<double> starts;
  std::vector<double> values{results.equality->mean};
  for (const ParticipantSettings& person : results.participants) {
    for (const Setting& setting : person.settings) {
      if (std::isfinite(setting.start)) {
        constexpr double size = 0.3;
        starts.push_back(setting.start);
        values.push_back(setting.value);
        chart.points.push_back({setting.start, setting.value, size});
      }
    }
  }
  if (chart.points.empty()) {
    return std::nullopt;
  }
  chart.caption = "Each setting against where it started; dashed: their mean over participants";
  chart.alternative =
      fmt::format("{} settings of {}; point of subjective equality {}", chart.points.size(),
                  axis.name.with_unit(), rounded(results.equality->mean));
  chart.x_label = "start, " + axis.name.with_unit();
  chart.y_label = "setting";
  chart.is_x_logarithmic = axis.is_logarithmic;
  chart.is_y_logarithmic = axis.is_logarithmic;
  chart.x_range = range_of(starts, axis.is_logarithmic);
  chart.y_range = range_of(values, axis.is_logarithmic);
  chart.levels = {results.equality->mean};
  return chart;
}

PersonalValues means_of(const AdjustedAxis& axis, const AdjustmentResults& results) {
  return personal_values(
      "setting of " + axis.name.with_unit(), axis.is_logarithmic, results.participants,
      [](const ParticipantSettings& person) { return std::optional{person.mean}; });
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_adjustments(const BlockDesign& design,
                                                    const BlockRows& rows) {
  const AdjustmentResults results = adjustment_results(design, rows.answers);
  const AdjustedAxis& axis = *design.adjusted;
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {estimates_table(axis, results), participants_table(axis, results),
                               settings_table(results)};
  summary->results().remarks = remarks_on(design, results);
  if (design.premise.empty()) {
    summary->personal = means_of(axis, results);
  }
  if (const auto chart = chart_of(axis, results)) {
    summary->results().charts.push_back(*chart);
  }
  if (results.equality && results.equality->interval) {
    summary->main_results.push_back(
        {fmt::format("point of subjective equality, {}", axis.name.with_unit()),
         results.equality->mean,
         *results.equality->interval,
         {},
         {},
         axis.is_logarithmic,
         results.equality->participants});
  }
  return summary;
}
}  // namespace tapstudy::analysis
