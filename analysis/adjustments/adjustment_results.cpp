#include "analysis/adjustments/adjustment_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/participants/mean_proportion.hpp"
#include "analysis/statistics/quantiles.hpp"
#include "core/error.hpp"
#include "core/number_in.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
constexpr std::uint64_t seed = 1;  // of draws, the same in every report
constexpr int draws = 4999;

double to_scale(const AdjustedAxis& axis, double value) {
  return axis.is_logarithmic ? std::log(value) : value;
}
double from_scale(const AdjustedAxis& axis, double value) {
  return axis.is_logarithmic ? std::exp(value) : value;
}

double value_of(const BlockDesign& design, const AnswerRow& answer) {
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

template <class Back>
std::optional<MeanOfSettings> mean_of(const std::vector<double>& values, Back back) {
  if (values.empty()) {
    return std::nullopt;
  }
  const auto both = [&](const Interval& interval) {
    return Interval{back(interval.low), back(interval.high)};
  };
  MeanOfSettings result{
      back(mean_and_spread(values).mean), {}, {}, static_cast<int>(values.size())};
  if (values.size() > 1) {
    result.interval = both(t_interval(values));
    if (const auto bootstrap = bootstrap_interval(values, draws, seed)) {
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
         value_of(design, answer)});
  }
  AdjustmentResults results;
  for (const auto& [name, settings] : people) {
    results.participants.push_back(participant_of(axis, name, settings));
  }
  const Columns columns = columns_of(axis, results.participants);
  const auto back = [&](double value) { return from_scale(axis, value); };
  results.equality = mean_of(columns.means, back);
  results.error = mean_of(columns.errors, back);
  results.deviation = mean_of(columns.deviations, [](double value) { return value; });
  results.hysteresis = mean_of(columns.differences, back);
  if (design.premise.empty()) {
    results.error_test = test_of(columns.errors);
    results.hysteresis_test = test_of(columns.differences);
  }
  return results;
}
}  // namespace tapstudy::analysis
