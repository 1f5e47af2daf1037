#include "runner/studies/scripted_tap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "core/model/shape/shape.hpp"
#include "core/text/plain_text.hpp"
#include "device/audio/actuator_source.hpp"
#include "device/hand/prescribed_hand.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/stimuli/model_library.hpp"
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

namespace {
constexpr double hover_m = 0.005;

double height_m(const ScriptedTap& tap, const core::Shape& shape) {
  const core::TopHeight top{shape};
  const auto height_m = top.at_m(tap.at_m);
  if (!height_m) {
    throw core::InvalidInput{fmt::format("--at: ({}, {}) is off the plate ({})", tap.at_m.x(),
                                         tap.at_m.y(), top.describe_touchable(tap.at_m))};
  }
  return *height_m;
}

void check(const ScriptedTap& tap) {
  if (!(tap.speed_m_s >= 0.001 && tap.speed_m_s <= 10.0)) {
    throw core::InvalidInput{
        fmt::format("--speed: {} is not allowed (from 0.001 to 10 m/s)", tap.speed_m_s)};
  }
  if (!(tap.seconds >= 0.01 && tap.seconds <= 60.0)) {
    throw core::InvalidInput{
        fmt::format("--seconds: {} is not allowed (from 0.01 to 60)", tap.seconds)};
  }
}

// Its force is the command.
core::ActuatorOutput ideal_actuator() {
  core::ActuatorOutput actuator;
  actuator.rate_hz = tap_actuator_rate_hz;
  actuator.response = core::ActuatorResponse::flat();
  return actuator;
}

TrialStimuli divided_stimuli(const protocols::Protocol& protocol,
                             const protocols::PresentedStimulus& stimulus, ModelLibrary& models) {
  const core::ActuatorOutput actuator = ideal_actuator();
  return build_trial_stimuli(protocol, std::vector{stimulus}, models,
                             protocol.rendering.crossover ? &actuator : nullptr);
}

// Runs the loop in virtual time and keeps every tick, and what the actuator renders until the next.
class TapRecorder {
 public:
  TapRecorder(device::Device& hand, TrialStimuli& stimuli, const device::LoopSettings& settings)
      : period_s_{1e-9 * static_cast<double>(settings.period)},
        loop_{hand, stimuli.alternatives, settings, ring_, clock_},
        source_{{tap_actuator_rate_hz, full_scale_n, {}, period_s_, 0.0}} {
    source_.use(stimuli.voices);
    loop_.use({&source_.ticks()});
    has_actuator_ = !stimuli.voices.empty();
  }
  TapTrace record(double seconds) {
    TapTrace trace;
    const auto ticks = static_cast<std::int64_t>(std::llround(seconds / period_s_));
    core::TraceSample sample{};
    for (std::int64_t i = 0; i < ticks; ++i) {
      loop_.run_ticks(1);
      while (ring_.try_pop(sample)) {
        trace.ticks.push_back(sample);
      }
      if (has_actuator_) {
        render(static_cast<double>(i + 1) * period_s_, trace.actuator_n);
      }
    }
    return trace;
  }

 private:
  static constexpr double full_scale_n = 1e6;
  void render(double until_s, std::vector<float>& rendered_n) {
    const auto samples = static_cast<std::size_t>(std::llround(until_s * tap_actuator_rate_hz));
    const std::size_t begin = rendered_n.size();
    const double frame_ns = 1e9 / tap_actuator_rate_hz;
    rendered_n.resize(samples);
    const auto period = std::span{rendered_n}.subspan(begin);
    source_.fill(period, std::llround(static_cast<double>(begin) * frame_ns), frame_ns,
                 clock_.now());
    for (float& force_n : period) {
      force_n *= static_cast<float>(full_scale_n);
    }
  }

  double period_s_;
  core::SpscRing<core::TraceSample> ring_{4};
  device::VirtualClock clock_;
  device::HapticLoop loop_;
  device::ActuatorSource source_;
  bool has_actuator_{false};
};

// The aim of the muscle in each tick, in the device frame.
std::vector<core::Vec3> aims_of(const ScriptPath& path, const core::Shape& shape,
                                const core::Placement& placement, double dt_s) {
  const core::TopHeight top{shape};
  std::vector<core::Vec3> aims_m;
  for (double t_s = 0.0; t_s <= path.duration_s();
       t_s = static_cast<double>(aims_m.size()) * dt_s) {
    core::Vec3 aim_m = path.at(t_s);
    const Eigen::Vector2d sideways_m = aim_m.head<2>();
    const auto height_m = top.at_m(sideways_m);
    if (!height_m) {
      throw core::InvalidInput{
          fmt::format("--script: the finger leaves the plate after {:.4g} s at "
                      "({:.4g}, {:.4g}) ({})",
                      t_s, sideways_m.x(), sideways_m.y(), top.describe_touchable(sideways_m))};
    }
    aim_m.z() += *height_m;
    aims_m.push_back(placement.point_to_device(aim_m));
  }
  return aims_m;
}
}  // namespace

TapTrace trace_of(const ScriptedTap& tap, const protocols::Protocol& protocol,
                  const protocols::Rig& rig, ModelLibrary& models) {
  const protocols::Plate& plate = *tap.stimulus.plate;
  check(tap);
  const double z_m = height_m(tap, plate.shape);
  const device::LoopSettings settings = loop_settings(protocol, rig);
  device::SimulatedHand hand{protocol.simulation.hand, protocol.rendering.dt_s,
                             device::SimulatedHand::Memory::none};
  device::PlannedTap planned;
  planned.point_m = settings.placement.scaled(plate.lateral_ratio)
                        .point_to_device({tap.at_m.x(), tap.at_m.y(), z_m});
  planned.speed_m_s = tap.speed_m_s;
  planned.hover_m = hover_m;
  planned.run_up_m = 0.0;
  planned.press_m = protocol.simulation.taps.press_m;
  planned.dwell_s = tap.seconds;
  hand.follow({planned});
  TrialStimuli stimuli = divided_stimuli(protocol, tap.stimulus, models);
  return TapRecorder{hand, stimuli, settings}.record(hover_m / tap.speed_m_s + tap.seconds);
}

TapTrace trace_of(const protocols::PresentedStimulus& stimulus, const protocols::TapScript& script,
                  const protocols::Protocol& protocol, const protocols::Rig& rig,
                  ModelLibrary& models) {
  const protocols::Plate& plate = *stimulus.plate;
  const device::LoopSettings settings = loop_settings(protocol, rig);
  const double dt_s = protocol.rendering.dt_s;
  const core::HandBody& body = protocol.simulation.hand;
  const ScriptPath path{script, body, stimulus.rendering.penalty_stiffness_n_per_m};
  device::AimedHand hand{
      body, dt_s, aims_of(path, plate.shape, settings.placement.scaled(plate.lateral_ratio), dt_s)};
  TrialStimuli stimuli = divided_stimuli(protocol, stimulus, models);
  return TapRecorder{hand, stimuli, settings}.record(path.duration_s());
}

Eigen::Vector2d point_on_plate(const std::string& text, const protocols::Plate& plate) {
  const auto named = plate.tapping_points_m.find(text);
  if (named != plate.tapping_points_m.end()) {
    return named->second;
  }
  const auto at_m = core::two_numbers_in(text, ',');
  if (!at_m) {
    std::vector<std::string> names;
    for (const auto& [name, at] : plate.tapping_points_m) {
      names.push_back(name);
    }
    throw core::InvalidInput{
        fmt::format("--at: '{}' is neither X,Y in metres nor a tapping point (one of: {})", text,
                    fmt::join(names, ", "))};
  }
  return {at_m->first, at_m->second};
}
}  // namespace tapstudy::runner
