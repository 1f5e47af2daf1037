#include "analysis/statistics/resampling/replicates.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>
#include <vector>

#include "core/error.hpp"
#include "core/random/rng.hpp"
namespace tapstudy::analysis {
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        next = count;  // nobody begins another one
        throw;
      }
    }
  };
  const std::size_t wanted = threads > 0 ? threads : std::thread::hardware_concurrency();
  std::vector<std::future<void>> others;  // each waits for its thread when it is destroyed
  for (std::size_t i = 1; i < std::min(std::max<std::size_t>(wanted, 1), count); ++i) {
    others.push_back(std::async(std::launch::async, work));
  }
  work();
  for (std::future<void>& other : others) {
    other.get();
  }
}

namespace {
template <class Result>
std::vector<Result> all_replicates(int count,
                                   const std::function<Result(std::uint64_t seed)>& replicate,
                                   std::uint64_t seed, unsigned threads) {
  if (count < 0) {
    throw core::InvalidInput{"a number of replicates is not below 0"};
  }
  const auto size = static_cast<std::size_t>(count);
  std::vector<Result> results(size);
  parallel_for(size, threads, [&](std::size_t i) {
    results[i] = replicate(core::derived_seed(seed, core::Purpose::resampling, i));
  });
  return results;
}
}  // namespace

std::vector<double> replicates(int count, const Replicate& replicate, std::uint64_t seed,
                               unsigned threads) {
  return all_replicates<double>(count, replicate, seed, threads);
}

std::vector<std::vector<double>> replicated_vectors(int count, const Replicates& replicate,
                                                    std::uint64_t seed, unsigned threads) {
  return all_replicates<std::vector<double>>(count, replicate, seed, threads);
}

int affordable_replicates(std::size_t work_each, int fewest, int most) {
  constexpr std::size_t max_work = 20'000'000;
  return static_cast<int>(std::clamp<std::size_t>(max_work / std::max<std::size_t>(work_each, 1),
                                                  static_cast<std::size_t>(fewest),
                                                  static_cast<std::size_t>(most)));
}

double monte_carlo_p(const std::vector<double>& replicates, double observed) {
  const double limit = observed - 1e-9 * std::max(1.0, std::abs(observed));
  const auto as_large =
      std::ranges::count_if(replicates, [&](double value) { return value >= limit; });
  return (1.0 + static_cast<double>(as_large)) / (static_cast<double>(replicates.size()) + 1.0);
}
}  // namespace tapstudy::analysis
