#include "runner/experiments/scripted_tap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <span>

#include "core/error.hpp"
#include "core/model/shape/top_height.hpp"
#include "core/number_in.hpp"
#include "device/hand/aimed_hand.hpp"
#include "device/hand/simulated_hand.hpp"
#include "device/loop/haptic_loop.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/experiments/script_path.hpp"
#include "runner/stimuli/trial_stimuli.hpp"
namespace tapstudy::runner {
namespace {
constexpr double hover_m = 0.005;

double height_m(const ScriptedTap& tap, const core::Shape& shape) {
  const core::TopHeight top{shape};
  const auto height_m = top.at_m(tap.at_m);
  if (!height_m) {
    throw core::InvalidInput{fmt::format("--at: ({}, {}) is off the plate ({})", tap.at_m.x(),
                                         tap.at_m.y(), top.outline_words(tap.at_m))};
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

// In virtual time, every tick kept as it is.
std::vector<core::TraceSample> samples_of(device::Device& hand,
                                          std::span<core::TapRenderer> alternatives,
                                          const device::LoopSettings& settings, double seconds) {
  const auto ticks = static_cast<std::int64_t>(
      std::llround(seconds / (1e-9 * static_cast<double>(settings.period))));
  core::SpscRing<core::TraceSample> ring{static_cast<std::size_t>(ticks)};
  device::VirtualClock clock;
  device::HapticLoop loop{hand, alternatives, settings, ring, clock};
  loop.run_ticks(ticks);
  std::vector<core::TraceSample> samples;
  core::TraceSample sample{};
  while (ring.try_pop(sample)) {
    samples.push_back(sample);
  }
  return samples;
}

// Where the muscle aims in each tick, in the device frame.
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
                      t_s, sideways_m.x(), sideways_m.y(), top.outline_words(sideways_m))};
    }
    aim_m.z() += *height_m;
    aims_m.push_back(placement.point_to_device(aim_m));
  }
  return aims_m;
}
}  // namespace

std::vector<core::TraceSample> trace_of(const ScriptedTap& tap, const protocols::Protocol& protocol,
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
  TrialStimuli stimuli = build_trial_stimuli(protocol, std::vector{tap.stimulus}, models);
  return samples_of(hand, stimuli.alternatives, settings, hover_m / tap.speed_m_s + tap.seconds);
}

std::vector<core::TraceSample> trace_of(const protocols::PresentedStimulus& stimulus,
                                        const protocols::TapScript& script,
                                        const protocols::Protocol& protocol,
                                        const protocols::Rig& rig, ModelLibrary& models) {
  const protocols::Plate& plate = *stimulus.plate;
  const device::LoopSettings settings = loop_settings(protocol, rig);
  const double dt_s = protocol.rendering.dt_s;
  const core::HandBody& body = protocol.simulation.hand;
  const ScriptPath path{script, body, stimulus.rendering.penalty_stiffness_n_per_m};
  device::AimedHand hand{
      body, dt_s, aims_of(path, plate.shape, settings.placement.scaled(plate.lateral_ratio), dt_s)};
  TrialStimuli stimuli = build_trial_stimuli(protocol, std::vector{stimulus}, models);
  return samples_of(hand, stimuli.alternatives, settings, path.duration_s());
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
