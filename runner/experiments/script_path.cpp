#include "runner/experiments/script_path.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::runner {
namespace {
using protocols::TapStep;
using Action = TapStep::Action;
constexpr double travel_s = 0.3;
constexpr double gathering_s = 0.1;
constexpr double falling_s = 0.15;  // some seven time constants of the default hand
constexpr double lifted_m = 0.01;
constexpr double rounding_s = 1e-9;

double progress(double u) {
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));  // minimum jerk (Flash & Hogan 1985)
}
}  // namespace

double aim_below_m(double force_n, const core::HandBody& hand, double contact_stiffness_n_per_m) {
  return force_n * (1.0 / contact_stiffness_n_per_m + 1.0 / hand.muscle_stiffness_n_per_m);
}

ScriptPath::ScriptPath(const protocols::TapScript& script, const core::HandBody& hand,
                       double contact_stiffness_n_per_m) {
  double below_m = 0.0;
  for (const TapStep& step : script.steps) {
    if (step.action == Action::strike || step.action == Action::press) {
      below_m = aim_below_m(step.force_n, hand, contact_stiffness_n_per_m);
    }
    if (step.action == Action::strike) {
      strike(step, below_m);
      continue;
    }
    wait_until(start_of(step, now_s_));
    core::Vec3 to = here_;
    double duration_s = step.duration_s;
    if (step.action == Action::press) {
      to.z() = -below_m;
    } else if (step.action == Action::slide) {
      to.head<2>() = step.place_m;
      duration_s = (to - here_).norm() / step.speed_m_s;
    } else {
      to.z() = lifted_m;
      duration_s = (to - here_).norm() / step.speed_m_s;
    }
    go(to, duration_s, Pace::even);
  }
  duration_s_ = now_s_ + script.rest_s;
}

void ScriptPath::strike(const TapStep& step, double below_m) {
  const double speed = step.speed_m_s;
  const core::Vec3 surface{step.place_m.x(), step.place_m.y(), 0.0};
  const core::Vec3 above = surface + core::Vec3{0.0, 0.0, speed * (0.5 * gathering_s + falling_s)};
  if (legs_.empty()) {
    here_ = above;
  } else {
    go(above, travel_s, Pace::minimum_jerk);
  }
  const double descent_s = gathering_s + falling_s;
  wait_until(start_of(step, now_s_ + descent_s) - descent_s);
  go(above - core::Vec3{0.0, 0.0, 0.5 * speed * gathering_s}, gathering_s, Pace::gathering);
  go(surface - core::Vec3{0.0, 0.0, below_m}, falling_s + below_m / speed, Pace::even);
}

double ScriptPath::start_of(const TapStep& step, double earliest_s) const {
  const double start_s = step.start_s.value_or(earliest_s);
  if (start_s < earliest_s - rounding_s) {
    throw core::InvalidInput{
        fmt::format("{}.start_s: {} is too early (the finger is ready at {:.4g} s)", step.stated_at,
                    start_s, earliest_s)};
  }
  return start_s;
}

void ScriptPath::go(const core::Vec3& to, double duration_s, Pace pace) {
  legs_.push_back({now_s_, duration_s, here_, to, pace});
  here_ = to;
  now_s_ += duration_s;
}

core::Vec3 ScriptPath::at(double t_s) const {
  const auto next = std::ranges::upper_bound(legs_, t_s, {}, &Leg::start_s);
  if (next == legs_.begin()) {
    return legs_.front().from;
  }
  const Leg& leg = *std::prev(next);
  const double u = leg.duration_s > 0.0 ? std::min(1.0, (t_s - leg.start_s) / leg.duration_s) : 1.0;
  double along = u;
  if (leg.pace == Pace::gathering) {
    along = u * u;
  } else if (leg.pace == Pace::minimum_jerk) {
    along = progress(u);
  }
  return leg.from + along * (leg.to - leg.from);
}
}  // namespace tapstudy::runner
