#pragma once
#include "analysis/statistics/count_table.hpp"
#include "core/rng.hpp"
namespace tapstudy::analysis {
// How many of `drawn` without replacement are marked, of a population of which so many are:
// hypergeometric, by inversion outward from the mode, or where that takes many steps by a ratio of
// uniforms. marked and drawn in [0, population].
std::int64_t random_hypergeometric(std::int64_t marked, std::int64_t drawn, std::int64_t population,
                                   core::Rng& rng);

// A table with the same totals of rows and columns, as shuffling the answers over the trials would
// give it (the distribution that Patefield 1981 draws from): cell by cell, each hypergeometric
// given those before it.
CountTable random_table(const TableTotals& totals, core::Rng& rng);

// One random table of each of these, of one shape, added up. Throws InvalidInput if there is none.
CountTable sum_of_random_tables(const std::vector<TableTotals>& totals, core::Rng& rng);

// About how much work such a sum is, for affordable_replicates: cells, and the steps of each.
std::size_t work_of_random_tables(const std::vector<CountTable>& tables);
}  // namespace tapstudy::analysis
