#include "analysis/statistics/independent_difference.hpp"

#include <cmath>
namespace tapstudy::analysis {
Estimate independent_difference(const Estimate& a, const Estimate& b) {
  const double difference = b.value - a.value;
  return {difference,
          {difference - std::hypot(b.value - b.interval.low, a.interval.high - a.value),
           difference + std::hypot(b.interval.high - b.value, a.value - a.interval.low)}};
}
}  // namespace tapstudy::analysis
