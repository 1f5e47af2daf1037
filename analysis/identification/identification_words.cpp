#include "analysis/identification/identification_words.hpp"

#include <fmt/format.h>

#include "analysis/blocks/pooled_proportion.hpp"
#include "analysis/blocks/wording.hpp"
namespace tapstudy::analysis {
std::string title_of(const FactorResult& result) {
  return result.given.empty() ? result.factor
                              : fmt::format("{}, given {} is right", result.factor, result.given);
}

std::string with_interval(const Proportion& pooled, const std::optional<MeanProportion>& over) {
  if (pooled.trials == 0) {
    return "no answers";
  }
  const std::string counted = fraction_and_percent(pooled);
  return over ? counted + " " + over_participants(pooled, *over)
              : fmt::format("{} ({} if answers are independent)", counted,
                            percent_range(wilson_interval(pooled)));
}
}  // namespace tapstudy::analysis
