#include "analysis/report/statistic.hpp"

#include <algorithm>

#include "analysis/adjustments/adjustment_summary.hpp"
#include "analysis/choice/choice_summary.hpp"
#include "analysis/discrimination/discrimination_summary.hpp"
#include "analysis/equality/equality_summary.hpp"
#include "analysis/identification/identification_summary.hpp"
#include "analysis/magnitudes/magnitude_summary.hpp"
#include "analysis/preferences/preference_summary.hpp"
#include "analysis/rankings/ranking_summary.hpp"
#include "analysis/ratings/rating_summary.hpp"
#include "analysis/thresholds/threshold_summary.hpp"
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
