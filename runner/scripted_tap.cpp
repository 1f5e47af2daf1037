#include "runner/scripted_tap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>

#include "core/error.hpp"
#include "core/model/shape/top_height.hpp"
#include "device/simulated_hand.hpp"
#include "results/trace_codec.hpp"
#include "runner/presenter.hpp"
#include "runner/rig.hpp"
#include "runner/scene.hpp"
namespace tapstudy::runner {
namespace {
constexpr double hover_m = 0.005;

double height_m(const ScriptedTap& tap, const core::Shape& shape) {
  const auto height_m = core::TopHeight{shape}.at_m(tap.at_m);
  if (!height_m) {
    const core::Bounds body = core::bounds(shape);
    throw core::InvalidInput{fmt::format(
        "--at: ({}, {}) is off the plate (x from {} to {} m, y from {} to {} m)", tap.at_m.x(),
        tap.at_m.y(), body.low_m.x(), body.high_m.x(), body.low_m.y(), body.high_m.y())};
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

std::optional<double> number(const std::string& text) {
  double value{};
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stopped == end ? std::optional{value} : std::nullopt;
}
}  // namespace

std::vector<core::TraceSample> trace_of(const ScriptedTap& tap, const protocols::Protocol& protocol,
                                        const protocols::Rig& rig, ModelLibrary& models) {
  const protocols::Stimulus& stimulus = protocol.stimulus(tap.stimulus);
  check(tap);
  const double z_m = height_m(tap, protocol.plates.at(stimulus.plate).shape);
  const device::LoopSettings settings = loop_settings(protocol, rig);
  device::SimulatedHand hand{hand_body(protocol.simulation.hand), protocol.rendering.dt_s,
                             device::SimulatedHand::Memory::none};
  device::PlannedTap planned;
  planned.point_m = settings.placement.point_to_device({tap.at_m.x(), tap.at_m.y(), z_m});
  planned.speed_m_s = tap.speed_m_s;
  planned.hover_m = hover_m;
  planned.run_up_m = 0.0;
  planned.press_m = protocol.simulation.taps.press_m;
  planned.dwell_s = tap.seconds;
  hand.follow({planned});
  Scene scene = build_scene(protocol, {tap.stimulus}, models);
  const Presented presented =
      VirtualPresenter{hand, settings}.present(scene.alternatives, [&](Exploration& exploration) {
        exploration.pass_time(hover_m / tap.speed_m_s + tap.seconds);
      });
  std::vector<core::TraceSample> samples;
  for (const results::TraceChunk& chunk : presented.trace.chunks) {
    const auto decoded = results::decode_trace(chunk.bytes, static_cast<std::size_t>(chunk.ticks));
    samples.insert(samples.end(), decoded.begin(), decoded.end());
  }
  return samples;
}

Eigen::Vector2d point_on_plate(const std::string& text, const protocols::Protocol& protocol) {
  const auto named = protocol.tapping_points_m.find(text);
  if (named != protocol.tapping_points_m.end()) {
    return named->second;
  }
  const auto comma = text.find(',');
  const auto x = number(text.substr(0, comma));
  const auto y = comma == std::string::npos ? std::nullopt : number(text.substr(comma + 1));
  if (!x || !y) {
    std::vector<std::string> names;
    for (const auto& [name, at] : protocol.tapping_points_m) {
      names.push_back(name);
    }
    throw core::InvalidInput{
        fmt::format("--at: '{}' is neither X,Y in metres nor a tapping point (one of: {})", text,
                    fmt::join(names, ", "))};
  }
  return {*x, *y};
}
}  // namespace tapstudy::runner
