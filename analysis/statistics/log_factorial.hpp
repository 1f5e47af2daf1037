#pragma once
#include <cstdint>
namespace tapstudy::analysis {
// ln n!, n >= 0, from any thread: a table below 1024, Stirling's series above (to 1e-15, relative).
double log_factorial(std::int64_t n);
}  // namespace tapstudy::analysis
