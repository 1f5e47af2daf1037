#pragma once
#include "analysis/tables/cells.hpp"
#include "analysis/tables/chart.hpp"
#include "analysis/thresholds/participant_thresholds.hpp"
namespace tapstudy::analysis {
// Results as tables, figures and sentences.
std::vector<ReportTable> threshold_tables(const BlockDesign& design,
                                          const ThresholdResults& results);
std::vector<Chart> threshold_charts(const BlockDesign& design, const ThresholdResults& results);
std::vector<std::string> threshold_remarks(const BlockDesign& design,
                                           const ThresholdResults& results);
// What levels are of, with the axis.
std::string level_words(const VariedAxis& axis);
}  // namespace tapstudy::analysis
