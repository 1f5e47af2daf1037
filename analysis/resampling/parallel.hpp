#pragma once
#include <cstddef>
#include <functional>
namespace tapstudy::analysis {
// task(0) to task(count - 1) on so many threads, 0: as many as there are processors; they must be
// independent of one another. Throws the first error of a task once all threads have ended.
void parallel_for(std::size_t count, unsigned threads,
                  const std::function<void(std::size_t)>& task);
}  // namespace tapstudy::analysis
