#include "analysis/report/statistic.hpp"

#include <algorithm>

#include "analysis/report/blocks/adjustments.hpp"
#include "analysis/report/blocks/choices.hpp"
#include "analysis/report/blocks/discrimination.hpp"
#include "analysis/report/blocks/equality.hpp"
#include "analysis/report/blocks/magnitudes.hpp"
#include "analysis/report/blocks/preferences.hpp"
#include "analysis/report/blocks/rankings.hpp"
#include "analysis/report/blocks/ratings.hpp"
#include "analysis/report/blocks/thresholds.hpp"
#include "analysis/report/confusion/confusion_summary.hpp"
#include "core/error.hpp"
namespace tapstudy::analysis {
const std::vector<Statistic>& statistics() {
  static const std::vector<Statistic> table{
      {"confusion", summarise_identification}, {"choices", summarise_choice},
      {"psychometric", summarise_thresholds},  {"discrimination", summarise_discrimination},
      {"paired", summarise_preferences},       {"ratings", summarise_ratings},
      {"magnitudes", summarise_magnitudes},    {"adjustments", summarise_adjustments},
      {"rankings", summarise_rankings},        {"equality", summarise_equality}};
  return table;
}

const Statistic& find_statistic(const std::string& name) {
  const auto found = std::ranges::find(statistics(), std::string_view{name}, &Statistic::name);
  if (found == statistics().end()) {
    throw core::InvalidInput{"report: there is no statistic '" + name + "'"};
  }
  return *found;
}
}  // namespace tapstudy::analysis
