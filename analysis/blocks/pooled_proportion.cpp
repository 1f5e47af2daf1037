#include "analysis/blocks/pooled_proportion.hpp"

#include <fmt/format.h>

#include "analysis/blocks/wording.hpp"
#include "analysis/participants/mean_proportion.hpp"
namespace tapstudy::analysis {
Cell pooled_proportion(const std::vector<Proportion>& participants) {
  if (participants.size() == 1) {
    return proportion(participants.front());
  }
  const Proportion all = sum(participants);
  if (all.trials == 0) {
    return proportion(all);
  }
  Cell cell = counted(all);
  if (const auto over = beta_binomial_mean(participants)) {
    cell.text += fmt::format(" (95 % CI {})", percent_range(over->interval));
    cell.values.insert(cell.values.end(), {over->interval.low, over->interval.high});
  } else {
    cell.values.resize(cell.values.size() + 2);
  }
  return cell;
}
}  // namespace tapstudy::analysis
