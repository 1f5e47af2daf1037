#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>
namespace tapstudy::analysis {
// task(0) to task(count - 1) on so many threads, 0: as many as there are processors; they must be
// independent of one another. Throws the first error of a task once all threads have ended.
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)>& task);

// The statistic of one replicate of a bootstrap or a permutation, from its own seed alone.
using Replicate = std::function<double(std::uint64_t seed)>;

// count replicates, in order, on so many threads (0: one a processor). Each has a seed derived from
// `seed` and its number, so that the results do not depend on the threads. An exception of a
// replicate is rethrown. Throws InvalidInput if count is below 0.
std::vector<double> replicates(int count, const Replicate& replicate, std::uint64_t seed,
                               unsigned threads = 0);

// The same for replicates that give several numbers: result[replicate][number].
using Replicates = std::function<std::vector<double>(std::uint64_t seed)>;
std::vector<std::vector<double>> replicated_vectors(int count, const Replicates& replicate,
                                                    std::uint64_t seed, unsigned threads = 0);

// The number of replicates of this much work (cells, answers …) that a report can afford, between
// fewest and most.
int affordable_replicates(std::size_t work_each, int fewest, int most);

// (1 + replicates at least as large as observed) / (replicates + 1) (Hope 1968). Values that differ
// by rounding count as equal.
double monte_carlo_p(const std::vector<double>& replicates, double observed);
}  // namespace tapstudy::analysis
