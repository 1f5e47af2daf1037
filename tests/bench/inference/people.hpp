#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/statistics/proportion.hpp"
#include "analysis/statistics/resampling/null_tables.hpp"
#include "core/random/rng.hpp"
#include "inference/rows.hpp"
namespace tapstudy::bench {
// One of so many answers, after the last one.
std::size_t guess(Guesser guesser, std::size_t answers, std::optional<std::size_t> last,
                  core::Rng& rng);

// 0 to kinds - 1, each so often, in random order.
std::vector<std::size_t> shuffled(std::size_t kinds, int each, core::Rng& rng);

// Of a beta distribution; the mean where people do not differ (0).
double personal_share(double mean, double intraclass_correlation, core::Rng& rng);

// Right answers of one person.
analysis::Proportion answered(double share, int trials, core::Rng& rng);

enum class Trials { equal, some_stop, those_below_stop };  // 16; 30, and 6 of who stops
std::vector<analysis::Proportion> sample_of(double mean, Trials trials, const StudyDraw& draw);

// The test of differences by exchanging their signs, and the probability of what is further: of
// all patterns of few that differ from 0, else of 999.
double share_further_by_signs(const std::vector<double>& differences, core::Rng& rng);
Outcome sign_flips_of(const std::vector<double>& differences, core::Rng& rng);

// The exact sign test of differences.
Outcome sign_test_of(const std::vector<double>& differences);

// Of a randomisation test: fewer than in a report, which takes longer and has the same size.
inline constexpr int draws_of_a_test = 99;

// Of accuracy against so many random tables.
Outcome accuracy_against(const analysis::NullTables& tables, std::uint64_t seed);
}  // namespace tapstudy::bench
