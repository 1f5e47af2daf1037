#include "runner/laboratory/reproduce/tap_responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/formats.hpp"
#include "core/error.hpp"
#include "core/tick/coupled_finger.hpp"
#include "core/tick/modal_state.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/studies/scripted_tap.hpp"
namespace tapstudy::runner {
namespace {
double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) {
    most = std::max(most, std::abs(value));
  }
  return most;
}

// The signal limited to frequencies below the limit, by the discrete Fourier transform.
std::vector<double> below(const std::vector<double>& values, double limit_hz, double rate_hz) {
  const auto count = static_cast<double>(values.size());
  std::vector<double> kept(values.size(), 0.0);
  for (double bin = 0.0; bin * rate_hz / count < limit_hz; ++bin) {
    const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * bin / count);
    std::complex<double> phasor{1.0, 0.0};
    std::complex<double> sum{0.0, 0.0};
    for (const double value : values) {
      sum += value * std::conj(phasor);
      phasor *= turn;
    }
    sum *= (bin == 0.0 ? 1.0 : 2.0) / count;
    phasor = {1.0, 0.0};
    for (double& value : kept) {
      value += (sum * phasor).real();
      phasor *= turn;
    }
  }
  return kept;
}
}  // namespace

TapForce tap_force(const std::vector<core::TraceSample>& trace, double rate_hz) {
  const auto impact = std::ranges::find(trace, true, &core::TraceSample::impact);
  if (impact == trace.end()) {
    throw core::InvalidInput{"a tap without an impact has no vibration"};
  }
  TapForce force;
  for (auto sample = impact; sample != trace.end(); ++sample) {
    force.t_s.push_back(1e-9 * static_cast<double>(sample->t_ns - impact->t_ns));
    force.penalty.push_back(sample->penalty_n);
    force.vibration.push_back(sample->vibration_n);
  }
  force.penalty_n = largest(force.penalty);
  force.vibration_n = largest(force.vibration);
  const std::vector<double> low = below(force.vibration, low_limit_hz, rate_hz);
  std::vector<double> high = force.vibration;
  std::ranges::transform(high, low, high.begin(), std::minus{});
  force.low_n = largest(low);
  force.high_n = largest(high);
  return force;
}

namespace {
constexpr double width = 300.0;
constexpr double left = 34.0;
constexpr double right = 296.0;
constexpr double top_n = 8.0;  // of the upper axis
constexpr double vibration_range_n = 1.0;
constexpr double upper_zero = 84.0;
constexpr double n_to_px = 9.0;
constexpr double lower_zero = 130.0;
constexpr double vibration_to_px = 34.0;
constexpr double height = 184.0;

double place(double t_s) {
  return left + (right - left) * t_s / shown_s;
}

template <class Y>
std::string curve(const char* css, const TapForce& force, const Y& y) {
  std::string path;
  for (std::size_t i = 0; i < force.t_s.size() && force.t_s[i] <= shown_s; ++i) {
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? 'M' : 'L', place(force.t_s[i]), y(i));
  }
  return fmt::format("<path class={} d=\"{}\"/>", css, path);
}

std::string axis(double zero, double high, const char* at_high) {
  return fmt::format(
      "<path class=frame d=\"M{0} {1:.1f}V{2:.1f}H{3}\"/><text x={4} y={5:.1f} "
      "text-anchor=end>{6}</text><text x={4} y={7:.1f} text-anchor=end>0</text>",
      left, high, zero, right, left - 4.0, high + 8.0, at_high, zero + 4.0);
}
}  // namespace

std::string force_svg(const TapForce& force, const std::string& title) {
  const std::string caption =
      fmt::format("{}: penalty {} N, vibration {} N at most", title,
                  analysis::rounded(force.penalty_n), analysis::rounded(force.vibration_n));
  const auto clipped = [](double value, double most) { return std::clamp(value, -most, most); };
  return fmt::format(
             "<figure><svg class=\"chart force\" viewBox=\"0 0 {} {}\" role=img aria-label=\"{}\">",
             width, height, analysis::escaped(caption)) +
         axis(upper_zero, upper_zero - top_n * n_to_px, "8 N") +
         curve("line", force,
               [&](std::size_t i) {
                 return upper_zero -
                        n_to_px * clipped(force.penalty[i] + force.vibration[i], top_n);
               }) +
         axis(lower_zero, lower_zero - vibration_range_n * vibration_to_px, "1 N") +
         curve("alone", force,
               [&](std::size_t i) {
                 return lower_zero -
                        vibration_to_px * clipped(force.vibration[i], vibration_range_n);
               }) +
         fmt::format("<text x={:.1f} y={} text-anchor=end>0.3 s</text>", right, height - 6.0) +
         fmt::format("</svg><figcaption>{}</figcaption></figure>\n", analysis::escaped(caption));
}

namespace {
constexpr double tapped_s = 0.4;  // long enough for the 0.16 s that feeling takes, after a bounce

const core::Technique& coupled_finger() {
  const std::vector<const core::ForcePart*> alone{&core::coupled_vibration};
  return *std::ranges::find(core::techniques(), alone, &core::Technique::parts);
}
}  // namespace

RealTap real_tap(const core::VibratingPlate* plate, const core::RenderSettings& settings,
                 const Eigen::Vector2d& at_m, double seconds) {
  constexpr double pressed_m = 0.002;
  constexpr double speed_m_s = real_over_virtual_speed * tap_speed_m_s;
  const double dt_s = settings.dt_s;
  std::optional<core::ModalState> state;
  if (plate != nullptr) {
    state.emplace(plate->model, settings.integrator, dt_s);
    state->touch(plate->locator->locate(at_m.x(), at_m.y()), core::Vec3::UnitZ());
  }
  // a bare finger: nothing holds the hand beside it
  core::CoupledFinger finger{settings.finger, {settings.penalty_stiffness_n_per_m, 0.0}, dt_s};
  finger.begin(0.0, -speed_m_s, 0.0);
  const auto ticks = static_cast<Eigen::Index>(std::lround(seconds / dt_s));
  RealTap tap{Eigen::VectorXd{ticks}, Eigen::VectorXd::Zero(ticks), Eigen::VectorXd{ticks}};
  double velocity_m_s = 0.0;
  for (Eigen::Index i = 0; i < ticks; ++i) {
    core::SurfaceTick surface;
    if (state) {
      state->tick();
      surface = {state->previous_displacement_m(), state->displacement_m(),
                 state->compliance_m_per_n()};
    }
    const double hand_m = -std::min(pressed_m, speed_m_s * dt_s * static_cast<double>(i + 1));
    const double contact_n = finger.tick(hand_m, surface);
    tap.force_n[i] = finger.force_on_hand_n();
    tap.finger_m_s2[i] = (contact_n - tap.force_n[i]) / settings.finger.mass_kg;
    if (state) {
      state->push(-contact_n);
      tap.plate_m_s2[i] = (state->velocity_m_s() - velocity_m_s) / dt_s;
      velocity_m_s = state->velocity_m_s();
    }
  }
  return tap;
}

protocols::Protocol with_real_finger(protocols::Protocol protocol) {
  protocol.rate_hz = real_rate_hz;
  protocol.rendering.dt_s = 1.0 / real_rate_hz;
  protocol.rendering.integrator = core::Integrator::exact;
  protocol.rendering.finger.mass_kg = real_finger_kg;
  for (protocols::Stimulus& stimulus : protocol.stimuli) {
    stimulus.technique = &coupled_finger();
  }
  return protocol;
}

protocols::Rig unlimited_rig() {
  constexpr double none = std::numeric_limits<double>::infinity();
  protocols::Rig rig = simulated_rig();
  rig.gate.limits.max_force_n = none;
  rig.gate.limits.max_force_rate_n_per_s = none;
  return rig;
}

std::vector<FeltTap> felt_tap(const protocols::Protocol& protocol, const std::string& stimulus,
                              const std::string& point, double speed_m_s, ModelLibrary& models) {
  const auto presented = stimulus_with(protocol, protocol.stimulus(stimulus));
  const ScriptedTap tap{presented, presented.plate->tapping_points_m.at(point), speed_m_s,
                        tapped_s};
  std::vector<device::FeltTick> felt;
  for (const core::TraceSample& sample : trace_of(tap, protocol, unlimited_rig(), models).ticks) {
    const core::HandState hand{
        core::Vec3{sample.position_m[0], sample.position_m[1], sample.position_m[2]},
        core::Vec3::Zero()};
    felt.push_back({hand, {sample.force_n[0], sample.force_n[1], sample.force_n[2]}});
  }
  std::vector<FeltTap> taps =
      felt_taps(felt, protocol.rendering.dt_s, protocol.simulation.observer.threshold_n);
  if (taps.empty()) {
    throw core::InvalidInput{"no tap stays in contact for the 0.16 s that feeling it takes"};
  }
  return taps;
}

double level_db(const FeltTap& tap) {
  double power = 0.0;
  for (const double level : tap.level_db) {
    power += std::pow(10.0, level / 10.0) - 1.0;  // as features_of adds it
  }
  constexpr double least = 1e-12;
  return 10.0 * std::log10(std::max(power, least));
}
}  // namespace tapstudy::runner
