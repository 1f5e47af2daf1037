// Sections 5 and 7: with 5.8 g vibrations are far too small; ten times the mass makes them like
// real ones, because pointers move three times slower and for other reasons.
#include <fmt/format.h>

#include <cmath>

#include "runner/accuracy/felt_force.hpp"
#include "runner/reproduction/claim_table.hpp"
#include "runner/reproduction/real_tap.hpp"
#include "runner/reproduction/routes.hpp"
#include "runner/reproduction/shipped_protocols.hpp"
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

// By how much the force of a real tap differs from that on a rigid surface.
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
              .rule = level_rule + "Far smaller is 10 dB less, a third in force."};
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
              .rule = level_rule + "Similar is within 6 dB, a factor of two in force."};
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
          "The momentum m v of equation 14, within 20 % of three times. That taps were three "
          "times slower is taken from the paper."};
  claim.methods.push_back(
      {"equation 14",
       tap_command("protocols/paper/forces.yaml", "mdf_two", "P3", "--speed 0.3"),
       {within(2.4, 3.6, "virtual over real momentum", momentum)}});
  return claim;
}
}  // namespace

std::vector<Claim> finger_mass(Bench& bench) {
  const std::vector<Levels> all = levels_of(bench);
  return {too_small(all), similar(all), three_times_slower()};
}
}  // namespace tapstudy::runner
