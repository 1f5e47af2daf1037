// Sections 5 and 7: with 5.8 g vibrations are far too small; ten times the mass makes them like
// real ones, because pointers move three times slower and for other reasons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "analysis/modal/decay/decaying_sinusoid_fit.hpp"
#include "core/haptics/haptic_state.hpp"
#include "runner/laboratory/reproduce/claims.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/laboratory/reproduce/tap_responses.hpp"
#include "runner/laboratory/trade/rendering_accuracy.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/studies/scripted_tap.hpp"
namespace tapstudy::runner {
namespace {
constexpr double far_db = 10.0;  // a third in force
constexpr double felt_s = 0.16;
constexpr double similar_db = 6.0;  // a factor of two in force

const std::vector<std::string> shaken_plates{"mdf_two", "acrylic_two"};
const std::vector<std::string> points{"P1", "P2", "P3"};

double mean_level_db(Bench& bench, const protocols::Protocol& protocol, const std::string& plate,
                     double speed_m_s) {
  double sum = 0.0;
  for (const std::string& point : points) {
    core::tell(bench.progress, fmt::format("{} at {}", plate, point));
    sum += level_db(felt_tap(protocol, plate, point, speed_m_s, bench.models).front());
  }
  return sum / static_cast<double>(points.size());
}

struct Levels {
  std::string method;
  std::string file;
  std::string plate;
  double light_over_real_db{};  // 5.8 g
  double heavy_over_real_db{};  // 58 g
};

// The two virtual fingers and the real one, whose plate is held by screws whatever the virtual
// one is.
struct Fingers {
  std::string method;
  std::string file;
  protocols::Protocol light;
  protocols::Protocol heavy;
  protocols::Protocol real;
};

std::vector<Fingers> fingers(const Bench& bench) {
  std::vector<Fingers> all;
  for (const Route& route : bench.plates) {
    if (route.differs_in_aluminium_only) {
      continue;  // differs in aluminium only
    }
    const protocols::Protocol heavy = shipped_protocol(route.file);
    protocols::Protocol light = heavy;
    light.rendering.finger.mass_kg = real_finger_kg;
    all.push_back(
        {route.name, route.file, light, heavy,
         with_real_finger(route.is_printed ? shipped_protocol("protocols/recommended/forces.yaml")
                                           : heavy)});
  }
  return all;
}

// Against all that a real tap makes the finger feel.
Levels whole_tap(Bench& bench, const Fingers& of, const std::string& plate) {
  const double real_db =
      mean_level_db(bench, of.real, plate, real_over_virtual_speed * tap_speed_m_s);
  return {of.method + ", all of a real tap", of.file, plate,
          mean_level_db(bench, of.light, plate, tap_speed_m_s) - real_db,
          mean_level_db(bench, of.heavy, plate, tap_speed_m_s) - real_db};
}

double power_db(const Eigen::VectorXd& force_n) {
  return 10.0 * std::log10(force_n.squaredNorm() / static_cast<double>(force_n.size()));
}

double virtual_db(Bench& bench, const protocols::Protocol& protocol, const std::string& plate,
                  const Eigen::Vector2d& at_m) {
  const auto stimulus = stimulus_with(protocol, protocol.stimulus(plate));
  const auto ticks = static_cast<Eigen::Index>(std::lround(felt_s * protocol.rate_hz));
  const Strike strike{{at_m.x(), at_m.y(), 0.0}, tap_speed_m_s};
  return power_db(felt_force_n(*bench.models.plate_of(protocol, stimulus), stimulus.plate->shape,
                               stimulus.rendering, strike, ticks)
                      .matrix());
}

// The level of the difference between the force of a real tap and that on a rigid surface.
double plates_part_db(Bench& bench, const protocols::Protocol& real, const std::string& plate,
                      const Eigen::Vector2d& at_m) {
  const auto stimulus = stimulus_with(real, real.stimulus(plate));
  const auto model = bench.models.plate_of(real, stimulus);
  return power_db(real_tap(model.get(), stimulus.rendering, at_m, felt_s).force_n -
                  real_tap(nullptr, stimulus.rendering, at_m, felt_s).force_n);
}

// Against the plate's own part of it.
Levels plates_part(Bench& bench, const Fingers& of, const std::string& plate) {
  Levels levels{of.method + ", the plate's part of a real tap", of.file, plate, 0.0, 0.0};
  for (const std::string& point : points) {
    const Eigen::Vector2d at_m = of.heavy.tapping_points_m.at(point);
    const double real_db = plates_part_db(bench, of.real, plate, at_m);
    const auto count = static_cast<double>(points.size());
    levels.light_over_real_db += (virtual_db(bench, of.light, plate, at_m) - real_db) / count;
    levels.heavy_over_real_db += (virtual_db(bench, of.heavy, plate, at_m) - real_db) / count;
  }
  return levels;
}

std::vector<Levels> levels_of(Bench& bench) {
  std::vector<Levels> all;
  for (const Fingers& of : fingers(bench)) {
    for (auto* const compared : {whole_tap, plates_part}) {
      for (const std::string& plate : shaken_plates) {
        all.push_back(compared(bench, of, plate));
      }
    }
  }
  return all;
}

// One method for each route, with the measures of its plates.
template <class Measures>
void add(Claim& claim, const std::vector<Levels>& all, const Measures& measures) {
  for (const Levels& levels : all) {
    if (claim.methods.empty() || claim.methods.back().name != levels.method) {
      claim.methods.push_back({levels.method, tap_command(levels.file, levels.plate, "P3"), {}});
    }
    for (const Measure& measure : measures(levels)) {
      claim.methods.back().measures.push_back(measure);
    }
  }
}

constexpr const char* unknown_pad = "the stiffness and the damping of the finger's pad";
const std::string level_rule =
    "A real tap is a bare finger of 5.8 g, coupled to the plate at 48 kHz, three times as fast; "
    "levels are means of P1, P2 and P3, of the 0.16 s after an impact. Of all of a real tap: the "
    "power in third octaves from 20 to 320 Hz, after the contact spring is taken out. Of the "
    "plate's part: the power of the difference in force from the same tap on a rigid surface, "
    "beside the vibration force. ";

Claim too_small(const std::vector<Levels>& all) {
  Claim claim{.name = "light_finger_too_weak",
              .section = "section 5",
              .statement =
                  "With a finger of 5.8 g the presented vibrations are far smaller than those of "
                  "real taps.",
              .rule = level_rule + "Far smaller is 10 dB less, a third in force.",
              .unknown_input = unknown_pad};
  add(claim, all, [](const Levels& levels) {
    return std::vector{at_most(-far_db, levels.plate + ": 5.8 g over a real tap",
                               levels.light_over_real_db, "dB")};
  });
  claim.remarks.emplace_back(
      "The command taps with the protocol's finger of 58 g; the light one is a line of the "
      "protocol, finger.mass_kg: 0.0058.");
  return claim;
}

Claim similar(const std::vector<Levels>& all) {
  Claim claim{.name = "heavy_finger_similar",
              .section = "section 5",
              .statement = "With 58 g they are similar to those of real plates.",
              .rule = level_rule + "Similar is within 6 dB, a factor of two in force.",
              .unknown_input = unknown_pad};
  add(claim, all, [](const Levels& levels) {
    const std::string name = levels.plate + ": 58 g over a real tap";
    const double db = levels.heavy_over_real_db;
    return std::vector{within(-similar_db, similar_db, name, db, "dB")};
  });
  claim.remarks.emplace_back(
      "All of a real tap holds the vibration of the finger itself on its pad, which the virtual "
      "ones have not: see the finger's vibration below.");
  return claim;
}

Claim three_times_slower() {
  const double momentum = shipped_protocol("protocols/paper/forces.yaml").rendering.finger.mass_kg /
                          real_finger_kg / real_over_virtual_speed;
  Claim claim{
      .name = "momentum_three_times",
      .section = "section 7",
      .statement =
          "With ten times the mass and taps three times slower, the momentum of the "
          "virtual finger is around three times that of the real one.",
      .rule =
          "Not at all: the masses, and that taps were three times slower, are the paper's own. "
          "Shown is the momentum m v of equation 14."};
  claim.methods.push_back(
      {"equation 14",
       tap_command("protocols/paper/forces.yaml", "mdf_two", "P3", "--speed 0.3"),
       {shown("virtual over real momentum", momentum)}});
  return claim;
}
}  // namespace

std::vector<Claim> finger_mass(Bench& bench) {
  const std::vector<Levels> all = levels_of(bench);
  return {too_small(all), similar(all), three_times_slower()};
}

// Section 5.2.3: the finger's own vibration after an impact, and the decaying sinusoid that stands
// for it.
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

// The pad stiffness and damper with which a mass rings as the paper's finger does.
struct NeededFinger {
  double pad_n_per_m{};
  double damping_n_s_per_m{};
};
NeededFinger finger_ringing_as_printed(const core::Finger& finger) {
  const double decay = slowed_by * printed_decay_per_s;
  const double omega = 2.0 * pi * slowed_by * printed_hz;
  return {finger.mass_kg * (omega * omega + decay * decay) - finger.stiffness_n_per_m,
          2.0 * finger.mass_kg * decay};
}

enum class Pad { contact_spring, as_needed };

// The taps are on P1, beside a fixed point, where the paper's users complained. Screws hold real
// plates.
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
        const NeededFinger wanted = finger_ringing_as_printed(tap.settings.finger);
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
          "at 48 kHz and 0.9 m/s.",
      .unknown_input = unknown_pad};
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
          "plate between its swings.",
      .unknown_input = unknown_pad};
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
  const NeededFinger wanted = finger_ringing_as_printed(taps.front().settings.finger);
  claim.findings = {
      shown("pad stiffness with which 5.8 g in contact ring at 500 Hz", 1e-3 * wanted.pad_n_per_m,
            "kN/m"),
      shown("damping with which they decay by 1200 1/s", wanted.damping_n_s_per_m, "N s/m")};
  return claim;
}

// The force of a tap with the sinusoid alone, from the impact on.
std::vector<double> rendered_n(Bench& bench, const protocols::Protocol& protocol,
                               const char* stimulus, double speed_m_s, double& impact_m_s) {
  const auto presented = stimulus_with(protocol, protocol.stimulus(stimulus));
  const auto trace =
      trace_of(ScriptedTap{presented, presented.plate->tapping_points_m.at("P3"), speed_m_s, 0.1},
               protocol, simulated_rig(), bench.models)
          .ticks;
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
          {shown("largest difference from the printed formula", 100.0 * worst, "% of A"),
           shown("amplitude over speed, of twice the speed over once", ratio),
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
          "Not at all: the formula is the paper's own, and is what tapstudy renders. Shown is how "
          "near the force after an impact keeps to it, and A to the speed."};
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
