#pragma once
#include <cstddef>
#include <vector>

#include "analysis/paired/preference_scale.hpp"
namespace tapstudy::analysis {
// Items by place, the best first: each of them once.
using Ranking = std::vector<std::size_t>;
bool is_ranking(Ranking ranking, std::size_t items);

// Luce 1959; Plackett 1975. With worths exp(v), each place goes to one of the items that are left,
// in proportion to its worth:
//   P(ranking) = product over places k of exp(v_k) / sum over places l >= k of exp(v_l).
// The scale by maximum likelihood, all rankings independent. Throws InvalidInput for fewer than two
// items, rankings that are not of every item once, and where the items fall into two groups of
// which no member of one ever stood before any of the other: their distance is infinite (Hunter
// 2004).
PreferenceScale plackett_luce(const std::vector<Ranking>& rankings, std::size_t items);
}  // namespace tapstudy::analysis
