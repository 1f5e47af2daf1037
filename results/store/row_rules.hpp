#pragma once
#include <string>
#include <vector>

#include "results/store/store.hpp"
namespace tapstudy::results {
// Where rows of a store break a rule that every row keeps which this program writes, and that needs
// no protocol: rows are numbered from 1 without a gap, for none is ever removed; nothing stands
// twice; words are of their set, flags 0 or 1, times and counts not negative; simulated time is
// never late; a real plate, which is not rendered, has no ticks; each way in which a trial can end
// is noted as often as a trial ended so. A sentence for each broken rule, with the first rows.
std::vector<std::string> broken_rules(Store& store);
}  // namespace tapstudy::results
