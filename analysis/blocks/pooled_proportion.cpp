#include "analysis/blocks/pooled_proportion.hpp"

#include <fmt/format.h>

#include "analysis/blocks/wording.hpp"
namespace tapstudy::analysis {
std::string over_participants(const Proportion& all, const BetaBinomialMean& over) {
  const std::string mean = percent(over.mean);
  return mean == percent(all.value())
             ? fmt::format("(95 % CI over {} participants {})", over.participants,
                           percent_range(over.interval))
             : fmt::format("({} estimated over {} participants, 95 % CI {})", mean,
                           over.participants, percent_range(over.interval));
}

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
    cell.text += " " + over_participants(all, *over);
    cell.values.insert(cell.values.end(), {over->interval.low, over->interval.high});
  } else {
    cell.values.resize(cell.values.size() + 2);
  }
  return cell;
}
}  // namespace tapstudy::analysis
