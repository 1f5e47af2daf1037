#include "analysis/statistics/independent_difference.hpp"

#include <cmath>
namespace tapstudy::analysis {
IntervalEstimate independent_difference(const IntervalEstimate& a, const IntervalEstimate& b) {
  const double difference = b.value - a.value;
  return {difference,
          {difference - std::hypot(b.value - b.interval.low, a.interval.high - a.value),
           difference + std::hypot(b.interval.high - b.value, a.value - a.interval.low)}};
}
}  // namespace tapstudy::analysis
