#pragma once
#include <chrono>
#include <mutex>
namespace tapstudy::runner {
// Delays what comes faster than it should: a leaky bucket, by the virtual scheduling of the generic
// cell rate algorithm (ITU-T I.371, annex A). For any number of threads.
class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;
  // burst: what may come at once without a delay.
  RateLimit(double per_second, double burst);
  // How long something of this cost must wait that comes now. It counts from then on.
  Duration delay_of(double cost, Time now);

 private:
  double per_second_;
  Duration burst_;
  std::mutex mutex_;
  Time paid_until_;
};
}  // namespace tapstudy::runner
