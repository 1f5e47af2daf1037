#include "analysis/magnitudes/magnitude_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "analysis/magnitudes/magnitude_results.hpp"
#include "analysis/tables/tabular_summary.hpp"
namespace tapstudy::analysis {
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

std::vector<std::string> remarks_on(const BlockDesign& design, const Magnitudes& results) {
  if (results.empty()) {
    return {"There are no answers."};
  }
  if (!design.axis) {
    return {
        "Each participant's repeated estimates of a stimulus count as their geometric mean. There "
        "is no exponent: the stimuli have no values on an axis."};
  }
  std::vector<std::string> remarks{
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
  auto summary = std::make_shared<TabularSummary>(design);
  summary->parts = {exponents_table(design, results), means_table(design, results),
                    participants_table(results)};
  summary->remarks = remarks_on(design, results);
  for (const StimulusMagnitudes& of : results) {
    if (of.power_law) {
      summary->charts.push_back(chart_of(design, of));
      if (const auto& range = of.power_law->exponent_interval) {
        summary->main.push_back({"exponent of " + of.stimulus, of.power_law->exponent, *range});
      }
    }
  }
  return summary;
}
}  // namespace tapstudy::analysis
