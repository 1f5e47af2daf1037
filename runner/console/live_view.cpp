#include "runner/console/live_view.hpp"

#include <algorithm>
#include <cmath>

#include "core/placement.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::int64_t kept_steps = 600;
constexpr auto step_ns = static_cast<std::int64_t>(1e9 * LiveView::step_s);
}  // namespace

void LiveView::begin_trial() {
  const std::lock_guard lock{mutex_};
  totals_.contacts = 0;
  was_touching_ = false;
  last_tick_ns_.reset();
  has_step_ = false;
}

void LiveView::add(const core::TraceSample& sample) {
  if (sample.fault != core::TickFault::none) {
    return;  // its position may be NaN
  }
  const auto& [x, y, z] = sample.force_n;
  const std::lock_guard lock{mutex_};
  const double interval_s =
      1e-9 * static_cast<double>(sample.t_ns - last_tick_ns_.value_or(sample.t_ns));
  const Step step{std::hypot(x, y, z), core::Vec3{sample.position_m.data()}, interval_s};
  last_tick_ns_ = sample.t_ns;
  pointer_ = {core::Vec3{sample.position_m.data()}, sample.touching, sample.alternative,
              pointer_.tick + 1};
  ++totals_.ticks;
  totals_.late += sample.late ? 1 : 0;
  totals_.contacts += sample.touching && !was_touching_ ? 1 : 0;
  was_touching_ = sample.touching;
  if (has_step_ && sample.t_ns >= step_ends_ns_) {
    ring_.resize(kept_steps);
    ring_[static_cast<std::size_t>(ended_steps_ % kept_steps)] = step_;
    ++ended_steps_;
    has_step_ = false;
  }
  if (has_step_) {
    const bool is_lower = core::along_normal(step.lowest_m) < core::along_normal(step_.lowest_m);
    step_ = {std::max(step_.force_n, step.force_n), is_lower ? step.lowest_m : step_.lowest_m,
             std::max(step_.interval_s, step.interval_s)};
  } else {
    step_ = step;
    step_ends_ns_ = sample.t_ns - sample.t_ns % step_ns + step_ns;
    has_step_ = true;
  }
}

LiveView::Pointer LiveView::pointer() const {
  const std::lock_guard lock{mutex_};
  return pointer_;
}

LiveView::Totals LiveView::totals() const {
  const std::lock_guard lock{mutex_};
  return totals_;
}

LiveView::Steps LiveView::since(std::int64_t begin) const {
  const std::lock_guard lock{mutex_};
  Steps found{ended_steps_, {}};
  const std::int64_t oldest = std::max<std::int64_t>(0, ended_steps_ - kept_steps);
  for (std::int64_t i = std::max(begin, oldest); i < ended_steps_; ++i) {
    found.steps.push_back(ring_[static_cast<std::size_t>(i % kept_steps)]);
  }
  return found;
}
}  // namespace tapstudy::runner
