#include "analysis/thresholds/threshold_summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "analysis/discrimination/answer_counts.hpp"
#include "analysis/tables/tabular_summary.hpp"
#include "analysis/thresholds/threshold_tables.hpp"
namespace tapstudy::analysis {
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
