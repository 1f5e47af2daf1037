// Section 5.2.3: the finger's own vibration after an impact, and the decaying sinusoid that stands
// for it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "analysis/modal_identification/decaying_sinusoid_fit.hpp"
#include "core/placement.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/experiments/scripted_tap.hpp"
#include "runner/reproduction/claim_table.hpp"
#include "runner/reproduction/real_tap.hpp"
#include "runner/reproduction/routes.hpp"
#include "runner/reproduction/shipped_protocols.hpp"
namespace tapstudy::runner {
namespace {
constexpr double pi = std::numbers::pi;
constexpr double printed_hz = 250.0;
constexpr double printed_decay_per_s = 600.0;
constexpr double slowed_by = 2.0;  // of the finger's vibration
constexpr double compared_s = 0.05;
const char* const finger_protocol = "protocols/paper/reality_finger.yaml";

double root_mean_square(const Eigen::VectorXd& values) {
  return values.norm() / std::sqrt(static_cast<double>(values.size()));
}

struct TappedPlate {
  Route route;
  std::string stimulus;
  core::RenderSettings settings;
  RealTap found;
};

// Which pad and damper a mass would need to ring as the paper's finger does.
struct NeededFinger {
  double pad_n_per_m{};
  double damping_n_s_per_m{};
};
NeededFinger needed(const core::Finger& finger) {
  const double decay = slowed_by * printed_decay_per_s;
  const double omega = 2.0 * pi * slowed_by * printed_hz;
  return {finger.mass_kg * (omega * omega + decay * decay) - finger.stiffness_n_per_m,
          2.0 * finger.mass_kg * decay};
}

enum class Pad { contact_spring, as_needed };

// On P1, beside a fixed point, where the paper's users complained. Screws hold real plates.
std::vector<TappedPlate> real_taps(Bench& bench, Pad pad) {
  std::vector<TappedPlate> all;
  for (const Route& route : bench.plates) {
    if (route.is_printed || route.differs_in_aluminium_only) {
      continue;
    }
    const protocols::Protocol protocol = with_real_finger(shipped_protocol(route.file));
    for (const char* const name : {"mdf_two", "acrylic_two"}) {
      const auto stimulus = stimulus_with(protocol, protocol.stimulus(name));
      const auto plate = bench.models.plate_of(protocol, stimulus);
      TappedPlate tap{route, name, stimulus.rendering, {}};
      if (pad == Pad::as_needed) {
        const NeededFinger wanted = needed(tap.settings.finger);
        tap.settings.penalty_stiffness_n_per_m = wanted.pad_n_per_m;
        tap.settings.finger.damping_n_s_per_m = wanted.damping_n_s_per_m;
        tap.route.name +=
            ", with a pad and a damping that make it where the finger stays in contact";
      }
      tap.found = real_tap(plate.get(), tap.settings, stimulus.plate->tapping_points_m.at("P1"),
                           compared_s);
      all.push_back(std::move(tap));
    }
  }
  return all;
}

Method& method_of(Claim& claim, const TappedPlate& tap) {
  const std::string name = "real plates, " + tap.route.name;
  if (claim.methods.empty() || claim.methods.back().name != name) {
    claim.methods.push_back(
        {name,
         tap_command(tap.route.file, tap.stimulus, "P1",
                     fmt::format("--technique {} --csv tap.csv",
                                 with_real_finger(shipped_protocol(tap.route.file))
                                     .stimuli.front()
                                     .technique->name)),
         {}});
  }
  return claim.methods.back();
}

Claim plate_smaller(const std::vector<TappedPlate>& taps) {
  constexpr double printed_ratio = 100.0;
  Claim claim{
      .name = "plate_smaller_than_finger",
      .section = "section 5.2.3",
      .statement =
          "Of a tap on a fixed plate, the plate's vibration is at least 100 times "
          "smaller than the finger's.",
      .rule =
          "Root mean square of the accelerations in the 50 ms after an impact on P1; of the "
          "plate below 300 Hz. A bare finger of 5.8 g, coupled to the plate by its pad, "
          "at 48 kHz and 0.9 m/s."};
  for (const TappedPlate& tap : taps) {
    method_of(claim, tap)
        .measures.push_back(at_least(
            printed_ratio, tap.stimulus + " at P1: acceleration of finger over plate",
            root_mean_square(tap.found.finger_m_s2) / root_mean_square(tap.found.plate_m_s2)));
  }
  claim.remarks.emplace_back(
      "The command shows the same tap at the study's own rate and with its own finger.");
  return claim;
}

Claim twice_as_fast(const std::vector<TappedPlate>& taps) {
  constexpr double tolerance = 1.5;  // either way
  const double hz = slowed_by * printed_hz;
  const double decay = slowed_by * printed_decay_per_s;
  Claim claim{
      .name = "finger_twice_as_fast",
      .section = "section 5.2.3",
      .statement =
          "The finger's acceleration after an impact is a decaying sinusoid twice as "
          "fast as 250 Hz with a decay of 600 1/s.",
      .rule =
          "The sinusoid nearest to the computed acceleration has 500 Hz and 1200 1/s within "
          "a factor of 1.5. The paper gives no stiffness of the pad: that of the contact spring, "
          "3000 N/m, is taken, and the one that it would take if the finger did not leave the "
          "plate between its swings."};
  for (const TappedPlate& tap : taps) {
    const auto fitted =
        analysis::fit_decaying_sinusoid({real_rate_hz, tap.found.finger_m_s2}, {20.0, 2000.0});
    const double found_hz = fitted ? fitted->frequency_hz : std::nan("");
    const double found_decay = fitted ? fitted->decay_per_s : std::nan("");
    Method& method = method_of(claim, tap);
    method.measures.push_back(
        within(hz / tolerance, hz * tolerance, tap.stimulus + ": frequency", found_hz, "Hz"));
    method.measures.push_back(
        within(decay / tolerance, decay * tolerance, tap.stimulus + ": decay", found_decay, "1/s"));
  }
  const NeededFinger wanted = needed(taps.front().settings.finger);
  claim.findings = {
      shown("pad stiffness with which 5.8 g in contact ring at 500 Hz", 1e-3 * wanted.pad_n_per_m,
            "kN/m"),
      shown("damping with which they decay by 1200 1/s", wanted.damping_n_s_per_m, "N s/m")};
  return claim;
}

// What a tap with the sinusoid alone renders, from the impact on.
std::vector<double> rendered_n(Bench& bench, const protocols::Protocol& protocol,
                               const char* stimulus, double speed_m_s, double& impact_m_s) {
  const auto presented = stimulus_with(protocol, protocol.stimulus(stimulus));
  const auto trace =
      trace_of(ScriptedTap{presented, presented.plate->tapping_points_m.at("P3"), speed_m_s, 0.1},
               protocol, simulated_rig(), bench.models);
  const auto impact = std::ranges::find(trace, true, &core::TraceSample::impact);
  impact_m_s = -core::along_normal(impact->velocity_m_s);
  std::vector<double> force_n;
  for (auto sample = impact; sample != trace.end(); ++sample) {
    force_n.push_back(sample->sinusoid_n);
  }
  return force_n;
}

Method sinusoid_by(Bench& bench, const std::string& name, const std::string& file) {
  const protocols::Protocol protocol = shipped_protocol(file);
  const char* const stimulus = "decaying_sinusoid";
  const double amplitude = protocol.rendering.sinusoid.amplitude_n_s_per_m;
  double slow_m_s = 0.0;
  double fast_m_s = 0.0;
  const auto slow = rendered_n(bench, protocol, stimulus, tap_speed_m_s, slow_m_s);
  const auto fast = rendered_n(bench, protocol, stimulus, 2.0 * tap_speed_m_s, fast_m_s);
  double worst = 0.0;
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const double t_s = protocol.rendering.dt_s * static_cast<double>(i);
    const double printed =
        slow_m_s * std::exp(-printed_decay_per_s * t_s) * std::sin(2.0 * pi * printed_hz * t_s);
    worst = std::max(worst, std::abs(slow[i] / amplitude - printed) / slow_m_s);
  }
  const double ratio = (fast.at(1) / fast_m_s) / (slow.at(1) / slow_m_s);
  return {name,
          tap_command(file, stimulus, "P3"),
          {at_most(1.0, "largest difference from the printed formula", 100.0 * worst, "% of A"),
           within(0.99, 1.01, "amplitude over speed, of twice the speed over once", ratio),
           shown("amplitude A per speed, not printed", amplitude, "N s/m")}};
}

Claim sinusoid(Bench& bench) {
  Claim claim{
      .name = "sinusoid",
      .section = "section 5.2.3",
      .statement =
          "The added vibration is A exp(-600 t) sin(250 2π t), A proportional to the "
          "tapping velocity.",
      .rule =
          "The force rendered after an impact keeps to the formula within 1 % of A, and A to "
          "the speed within 1 %."};
  claim.methods.push_back(sinusoid_by(bench, std::string{method::printed}, finger_protocol));
  claim.methods.push_back(sinusoid_by(bench, std::string{method::recommended},
                                      "protocols/recommended/reality_finger.yaml"));
  claim.remarks.push_back(
      fmt::format("At 1 kHz a wave of {} Hz has four ticks, and its amplitude falls by a factor of "
                  "{:.2g} in each of them: the device is given one swing.",
                  printed_hz, std::exp(1e-3 * printed_decay_per_s)));
  return claim;
}
}  // namespace

std::vector<Claim> finger_vibration(Bench& bench) {
  const std::vector<TappedPlate> taps = real_taps(bench, Pad::contact_spring);
  std::vector<TappedPlate> all = taps;
  std::ranges::move(real_taps(bench, Pad::as_needed), std::back_inserter(all));
  return {sinusoid(bench), plate_smaller(taps), twice_as_fast(all)};
}
}  // namespace tapstudy::runner
