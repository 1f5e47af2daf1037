#pragma once
#include <vector>

#include "protocols/protocol.hpp"
#include "results/rows.hpp"
namespace tapstudy::runner {
// What a trial presents, as the store takes it.
std::vector<results::AlternativeRow> alternative_rows(const protocols::PlannedTrial& trial,
                                                      const protocols::Block& block);
}  // namespace tapstudy::runner
