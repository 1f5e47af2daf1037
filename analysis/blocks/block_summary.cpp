#include "analysis/blocks/block_summary.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_set>
namespace tapstudy::analysis {
std::vector<VisitOrder> orders_of(const std::vector<VisitOrder>& all,
                                  const std::vector<results::AnswerRow>& answers) {
  std::unordered_set<std::int64_t> trials;
  for (const results::AnswerRow& answer : answers) {
    trials.insert(answer.trial_id);
  }
  std::vector<VisitOrder> own;
  std::ranges::copy_if(all, std::back_inserter(own),
                       [&](const VisitOrder& order) { return trials.contains(order.trial_id); });
  return own;
}
}  // namespace tapstudy::analysis
