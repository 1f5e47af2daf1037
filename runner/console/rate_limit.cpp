#include "runner/console/rate_limit.hpp"

#include <algorithm>
namespace tapstudy::runner {
namespace {
RateLimit::Duration seconds(double s) {
  return std::chrono::duration_cast<RateLimit::Duration>(std::chrono::duration<double>{s});
}
}  // namespace

RateLimit::RateLimit(double per_second, double burst)
    : per_second_{per_second}, burst_{seconds(burst / per_second)} {}

RateLimit::Duration RateLimit::delay_of(double cost, Time now) {
  const std::lock_guard lock{mutex_};
  paid_until_ = std::max(paid_until_, now) + seconds(cost / per_second_);
  return std::max(Duration::zero(), paid_until_ - burst_ - now);
}
}  // namespace tapstudy::runner
