#include "analysis/report/blocks/magnitudes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/report/document/sections.hpp"
#include "core/error.hpp"
#include "core/text/plain_text.hpp"
namespace tapstudy::analysis {
namespace {
using results::AnswerRow;
using OnAxis = std::optional<double>;
// Logarithms to base 10 of one stimulus's estimates, by value and participant.
using Logarithms = std::map<OnAxis, std::map<std::string, std::vector<double>>>;

double number_of(const BlockDesign& design, const AnswerRow& answer) {
  const auto number = core::number_in<double>(answer.response);
  if (!number || !(*number > 0.0) || !std::isfinite(*number)) {
    throw core::InvalidInput{
        fmt::format("block '{}', {} in trial {}: a magnitude is a number above "
                    "0, not '{}'",
                    design.name, answer.participant_id, answer.number, answer.response)};
  }
  return *number;
}

// What stands before it is the modulus.
const results::AlternativeRow& judged(const AnswerRow& answer) {
  return answer.alternatives.back();
}

OnAxis axis_value(const BlockDesign& design, const AnswerRow& answer) {
  if (!design.axis || answer.alternatives.empty()) {
    return std::nullopt;
  }
  const results::AxisValues& values = judged(answer).axis_values;
  const auto found = values.find(design.axis->name.key);
  return found == values.end() ? OnAxis{} : OnAxis{found->second};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

MagnitudeOfValue mean_at(const OnAxis& value,
                         const std::map<std::string, std::vector<double>>& people) {
  MagnitudeOfValue result{value, 0.0, static_cast<int>(people.size()), 0};
  std::vector<double> means;
  for (const auto& [name, logarithms] : people) {
    means.push_back(mean_of(logarithms));
    result.estimates += static_cast<int>(logarithms.size());
  }
  result.geometric_mean = std::pow(10.0, mean_of(means));
  return result;
}

void add_power_law(StimulusMagnitudes& of, const Logarithms& logarithms) {
  std::map<std::string, Estimates> people;
  std::map<std::string, std::size_t> judged_values;
  for (const auto& [value, of_people] : logarithms) {
    if (!value) {
      of.no_power_law = "its trials have no value on an axis";
      return;
    }
    for (const auto& [name, estimates] : of_people) {
      ++judged_values[name];
      for (const double logarithm : estimates) {
        people[name].push_back({*value, std::pow(10.0, logarithm)});
      }
    }
  }
  std::vector<Estimates> all;
  for (const auto& [name, estimates] : people) {
    if (judged_values[name] < logarithms.size()) {
      of.incomplete.push_back(name);
      continue;
    }
    of.participants.push_back(name);
    all.push_back(estimates);
  }
  if (all.size() == 1 && people.size() > 1) {
    of.no_power_law = "only one participant judged all values";
    return;
  }
  try {
    of.power_law = power_law(all);
  } catch (const core::NotEstimable& error) {  // too few, or participants with other values
    of.no_power_law = error.what();
  }
}
}  // namespace

std::vector<StimulusMagnitudes> magnitude_results(const BlockDesign& design,
                                                  const std::vector<AnswerRow>& answers) {
  std::map<std::string, Logarithms> stimuli;
  for (const AnswerRow& answer : answers) {
    const std::string& stimulus =
        answer.alternatives.empty() ? answer.stimulus : judged(answer).stimulus;
    stimuli[stimulus][axis_value(design, answer)][answer.participant_id].push_back(
        std::log10(number_of(design, answer)));
  }
  std::vector<StimulusMagnitudes> results;
  for (const auto& [stimulus, logarithms] : stimuli) {
    StimulusMagnitudes of;
    of.stimulus = stimulus;
    add_power_law(of, logarithms);
    for (auto [value, people] : logarithms) {
      if (of.power_law) {  // each has their own unit: means are of the same people
        std::erase_if(people, [&](const auto& person) {
          return std::ranges::find(of.incomplete, person.first) != of.incomplete.end();
        });
      }
      of.values.push_back(mean_at(value, people));
    }
    results.push_back(of);
  }
  return results;
}

namespace {
using Magnitudes = std::vector<StimulusMagnitudes>;

ReportTable exponents_table(const BlockDesign& design, const Magnitudes& results) {
  ReportTable table{"power_law",
                    "Stevens' power law",
                    {column("stimulus", "stimulus"), column("participants", "participants"),
                     interval_column("exponent (95 % CI over participants)", "exponent"),
                     column("log10 constant", "log10_constant"), column("R squared", "r_squared"),
                     column("", "not_computed_because")}};
  for (const StimulusMagnitudes& of : results) {
    if (!design.axis) {
      break;
    }
    std::vector<Cell> row{word(of.stimulus)};
    if (const auto& law = of.power_law) {
      row.insert(row.end(), {count(static_cast<std::int64_t>(of.participants.size())),
                             interval(law->exponent, law->exponent_interval),
                             number(law->log_constant),
                             number(law->r_squared),
                             {"", {Value{}}}});
    } else {
      for (std::size_t i = 1; i + 1 < table.columns.size(); ++i) {
        row.push_back(nothing(table.columns[i]));
      }
      row.push_back(word(of.no_power_law));
    }
    table.rows.push_back(row);
  }
  return table;
}

ReportTable means_table(const BlockDesign& design, const Magnitudes& results) {
  ReportTable table{"means",
                    "Geometric means over participants",
                    {column("stimulus", "stimulus"),
                     column(design.axis ? design.axis->name.with_unit() : "value", "value"),
                     column("geometric mean", "geometric_mean"),
                     column("participants", "participants"), column("estimates", "estimates")}};
  for (const StimulusMagnitudes& of : results) {
    for (const MagnitudeOfValue& mean : of.values) {
      table.rows.push_back({word(of.stimulus), number(mean.value), number(mean.geometric_mean),
                            count(mean.participants), count(mean.estimates)});
    }
  }
  return table;
}

ReportTable participants_table(const Magnitudes& results) {
  ReportTable table{"participants",
                    "Exponents of the participants",
                    {column("stimulus", "stimulus"), column("participant", "participant_id"),
                     column("exponent", "exponent")}};
  for (const StimulusMagnitudes& of : results) {
    for (std::size_t i = 0; of.power_law && i < of.participants.size(); ++i) {
      table.rows.push_back({word(of.stimulus), word(of.participants[i]),
                            number(of.power_law->participant_exponents.at(i))});
    }
  }
  return table;
}

std::vector<CitingText> remarks_on(const BlockDesign& design, const Magnitudes& results) {
  if (results.empty()) {
    return {"There are no answers."};
  }
  if (!design.axis) {
    return {
        "Each participant's repeated estimates of a stimulus count as their geometric mean. There "
        "is no exponent: the stimuli have no values on an axis."};
  }
  std::vector<CitingText> remarks{
      "Each participant's repeated estimates of a value count as their geometric mean. Exponents "
      "by least squares of logarithms; the interval is by t over the participants' exponents."};
  for (const StimulusMagnitudes& of : results) {
    if (!of.incomplete.empty()) {
      remarks.push_back(fmt::format(
          "The exponent and the means of {} leave out who did not judge all values: {}.",
          of.stimulus, fmt::join(of.incomplete, ", ")));
    }
    if (!of.power_law) {
      remarks.push_back(fmt::format("{} has no exponent: {}.", of.stimulus, of.no_power_law));
    }
  }
  return remarks;
}

Chart chart_of(const BlockDesign& design, const StimulusMagnitudes& of) {
  const PowerLaw& law = *of.power_law;
  std::vector<double> values;
  std::vector<double> means;
  Chart chart;
  for (const MagnitudeMean& mean : law.means) {
    values.push_back(mean.value);
    means.push_back(mean.geometric_mean);
    constexpr double size = 0.4;
    chart.points.push_back({mean.value, mean.geometric_mean, size});
  }
  chart.caption = of.stimulus + ": geometric means and power law, both axes logarithmic";
  chart.alternative =
      fmt::format("Magnitude of {} against {}: exponent {}", of.stimulus,
                  design.axis->name.quantity, interval(law.exponent, law.exponent_interval).text);
  chart.x_label = design.axis->name.with_unit();
  chart.y_label = "magnitude";
  chart.is_x_logarithmic = true;
  chart.is_y_logarithmic = true;
  chart.x_range = range_of(values, true);
  chart.y_range = range_of(means, true);
  for (const double x : {values.front(), values.back()}) {
    chart.line.push_back({x, std::pow(10.0, law.log_constant + law.exponent * std::log10(x))});
  }
  return chart;
}
}  // namespace

std::shared_ptr<BlockSummary> summarise_magnitudes(const BlockDesign& design,
                                                   const BlockRows& rows) {
  const Magnitudes results = magnitude_results(design, rows.answers);
  auto summary = std::make_shared<BlockSummary>(design);
  summary->results().tables = {exponents_table(design, results), means_table(design, results),
                               participants_table(results)};
  summary->results().remarks = remarks_on(design, results);
  for (const StimulusMagnitudes& of : results) {
    if (of.power_law) {
      summary->results().charts.push_back(chart_of(design, of));
      if (const auto& range = of.power_law->exponent_interval) {
        summary->main_results.push_back(
            {"exponent of " + of.stimulus,
             of.power_law->exponent,
             *range,
             {},
             {},
             false,
             static_cast<int>(of.power_law->participant_exponents.size())});
      }
    }
  }
  return summary;
}
}  // namespace tapstudy::analysis
