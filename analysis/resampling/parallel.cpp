#include "analysis/resampling/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <future>
#include <thread>
#include <vector>
namespace tapstudy::analysis {
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)>& task) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      task(i);
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
}  // namespace tapstudy::analysis
