#include "device/remote/exerted_force.hpp"

#include <algorithm>
#include <cmath>
namespace tapstudy::device {
using core::TickFault;
namespace {
constexpr double peak_kept_a_tick = 0.9;  // a tenth is left after 22 ticks
constexpr double max_ratio = 2.0;
constexpr double margin_n = 1.0;
constexpr int max_ticks_above = 2;
constexpr int max_ticks_against = 5;
constexpr double min_ratio = 0.05;
constexpr int max_ticks_without = 30;
}  // namespace

TickFault ExertedForce::judge(const core::Vec3& commanded_n,
                              const core::Vec3& reported_n) noexcept {
  const double commanded = commanded_n.norm();
  const double reported = reported_n.norm();
  recent_peak_n_ = std::max(commanded, peak_kept_a_tick * recent_peak_n_);
  if (std::isnan(reported)) {
    return TickFault::none;
  }
  const bool is_above = reported > max_ratio * recent_peak_n_ + margin_n;
  const bool is_force = commanded >= noticeable_n;
  const double along = is_force ? reported_n.dot(commanded_n) / commanded : 0.0;
  const bool is_against = along <= -noticeable_n;
  const bool is_without = is_force && along < min_ratio * commanded;
  ticks_above_ = is_above ? ticks_above_ + 1 : 0;
  ticks_against_ = is_against ? ticks_against_ + 1 : 0;
  ticks_without_ = is_without ? ticks_without_ + 1 : 0;
  return ticks_above_ > max_ticks_above || ticks_against_ > max_ticks_against ||
                 ticks_without_ > max_ticks_without
             ? TickFault::force_not_followed
             : TickFault::none;
}
}  // namespace tapstudy::device
