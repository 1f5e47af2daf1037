#include "analysis/statistics/independent_difference.hpp"

#include <cmath>
namespace tapstudy::analysis {
IntervalEstimate independent_difference(const IntervalEstimate& a, const IntervalEstimate& b) {
  const double difference = b.value - a.value;
  return {difference,
          {difference - std::hypot(b.value - b.interval.low, a.interval.high - a.value),
           difference + std::hypot(b.interval.high - b.value, a.value - a.interval.low)}};
}

IntervalEstimate independent_ratio(const IntervalEstimate& a, const IntervalEstimate& b) {
  const auto map = [](const IntervalEstimate& of, auto to) {
    return IntervalEstimate{to(of.value), {to(of.interval.low), to(of.interval.high)}};
  };
  const auto log = [](double value) { return std::log(value); };
  const auto exp = [](double value) { return std::exp(value); };
  return map(independent_difference(map(a, log), map(b, log)), exp);
}
}  // namespace tapstudy::analysis
