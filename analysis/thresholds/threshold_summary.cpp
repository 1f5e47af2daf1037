#include "analysis/thresholds/threshold_summary.hpp"

#include "analysis/tables/tabular_summary.hpp"
#include "analysis/thresholds/threshold_tables.hpp"
namespace tapstudy::analysis {
std::shared_ptr<BlockSummary> summarise_thresholds(const BlockDesign& design,
                                                   const BlockRows& rows) {
  const ThresholdResults results = participant_thresholds(design, rows.answers);
  auto summary = std::make_shared<TabularSummary>(design);
  summary->parts = threshold_tables(design, results);
  summary->charts = threshold_charts(design, results);
  summary->remarks = threshold_remarks(design, results);
  for (const PlannedHypothesis& planned : design.hypotheses) {
    summary->hypotheses.push_back(
        {planned,
         "thresholds are estimated, with intervals; no test compares them",
         {},
         design.guess_rate,
         {},
         0.0});
  }
  return summary;
}
}  // namespace tapstudy::analysis
