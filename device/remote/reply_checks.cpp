#include "device/remote/reply_checks.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double max_ratio = 2.0;
constexpr double margin_n = 1.0;
constexpr double max_above_s = 0.0025;
constexpr double max_against_s = 0.0055;
constexpr double min_ratio = 0.05;
constexpr double max_without_s = max_report_lag_s + 0.03;

void count(double& total_s, bool is_so, double elapsed_s) noexcept {
  total_s = is_so ? total_s + elapsed_s : 0.0;
}
}  // namespace

void ExertedForce::remember(const core::Vec3& commanded_n, double elapsed_s) noexcept {
  current_s_ += elapsed_s;
  if (current_s_ > 0.5 * max_report_lag_s) {
    recent_ = {Commands{commanded_n, commanded_n}, recent_[0], recent_[1]};
    current_s_ = 0.0;
  }
  recent_[0].low_n = recent_[0].low_n.cwiseMin(commanded_n);
  recent_[0].high_n = recent_[0].high_n.cwiseMax(commanded_n);
}

double ExertedForce::largest_along(const core::Vec3& direction) const noexcept {
  double largest = 0.0;
  for (const Commands& commands : recent_) {
    const core::Vec3 furthest = (direction.array() > 0.0).select(commands.high_n, commands.low_n);
    largest = std::max(largest, furthest.dot(direction));
  }
  return largest;
}

TickFault ExertedForce::judge(const core::Vec3& commanded_n, const core::Vec3& reported_n,
                              double elapsed_s) noexcept {
  remember(commanded_n, elapsed_s);
  const double commanded = commanded_n.norm();
  const double reported = reported_n.norm();
  const bool is_told = !std::isnan(reported);
  has_told_ = has_told_ || is_told;
  count(untold_s_, has_told_ && !is_told, elapsed_s);
  if (!is_told) {
    return untold_s_ > max_report_lag_s ? TickFault::force_not_followed : TickFault::none;
  }
  const double explained_n = reported > 0.0 ? largest_along(reported_n / reported) : 0.0;
  const bool is_force = commanded >= noticeable_n;
  const double along = is_force ? reported_n.dot(commanded_n) / commanded : 0.0;
  count(above_s_, reported > max_ratio * explained_n + margin_n, elapsed_s);
  count(against_s_, along <= -noticeable_n && explained_n < min_ratio * reported, elapsed_s);
  count(without_s_, is_force && along < min_ratio * commanded, elapsed_s);
  return above_s_ > max_above_s || against_s_ > max_against_s || without_s_ > max_without_s
             ? TickFault::force_not_followed
             : TickFault::none;
}

namespace {
constexpr double window_length_s = 0.05;
constexpr double noticeable_m = 0.002;
constexpr double tolerance = 0.5;
constexpr int max_disagreements = 20;
}  // namespace

TickFault VelocityCheck::judge(const core::HandState& hand, double elapsed_s) noexcept {
  if (has_begun_) {
    integrated_m_ += elapsed_s * hand.velocity_m_s;
    window_s_ += elapsed_s;
    if (window_s_ < window_length_s) {
      return TickFault::none;
    }
    const core::Vec3 moved_m = hand.position_m - began_at_m_;
    const double larger_m = std::max(moved_m.norm(), integrated_m_.norm());
    if (larger_m >= noticeable_m) {
      const bool agrees = (moved_m - integrated_m_).norm() <= tolerance * larger_m;
      disagreements_ = std::max(disagreements_ + (agrees ? -1 : 1), 0);
    }
  }
  has_begun_ = true;
  began_at_m_ = hand.position_m;
  integrated_m_.setZero();
  window_s_ = 0.0;
  return disagreements_ > max_disagreements ? TickFault::velocity_wrong : TickFault::none;
}

TickFault SampleCheck::judge(const RemoteSample& sample, double elapsed_s) noexcept {
  const bool has_fallen = is_known_ && sample.number < number_;
  const double risen =
      is_known_ && !has_fallen ? static_cast<double>(sample.number - number_) : 0.0;
  still_s_ = is_known_ && sample.number == number_ ? still_s_ + elapsed_s : 0.0;
  number_ = sample.number;
  is_known_ = true;
  if (has_fallen || risen > 1.0 + 2.0 * rate_hz_ * (elapsed_s + max_age_s_)) {
    return TickFault::bad_reply;
  }
  return sample.age_s > max_age_s_ || still_s_ > max_age_s_ ? TickFault::position_frozen
                                                            : TickFault::none;
}

int SamplesSince::counted(const RemoteSample& sample, bool is_force_exerted,
                          double since_s) noexcept {
  const bool is_new = number_ && sample.number > *number_ && sample.age_s < since_s;
  number_ = number_ ? std::max(*number_, sample.number) : sample.number;
  count_ = is_force_exerted ? 0 : count_ + (is_new ? 1 : 0);
  return count_;
}
}  // namespace tapstudy::device
