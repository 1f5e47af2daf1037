// Figures 4 and 5: the feedback force of taps on P1, P2 and P3 of plates of three materials, held
// at two points and at four.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "runner/laboratory/reproduce/claims.hpp"
#include "runner/laboratory/reproduce/paper_protocols.hpp"
#include "runner/laboratory/reproduce/tap_responses.hpp"
#include "runner/session/devices/rigs.hpp"
namespace tapstudy::runner {
namespace {
constexpr double visible = 2.0;  // % of the largest penalty force: the stroke of a printed figure
constexpr double large = 5.0;    // %
const std::string visible_rule =
    "Vibration is seen in a figure of the whole force if it reaches 2 % of the largest penalty "
    "force, as much as the stroke of a printed curve. ";
const std::string band_rule =
    "Low-frequency modes are those below 100 Hz, a third of the band, high-frequency ones those "
    "above.";

struct Taps {
  Route route;
  double least_modulus_pa{};  // of MDF and acrylic
  double aluminium_pa{};
  std::map<std::string, TapForce> force{};  // "mdf_two P1"
  const TapForce& at(const std::string& material, const char* fixations, const char* point) const {
    return force.at(fmt::format("{}_{} {}", material, fixations, point));
  }
};

Taps taps_of(Bench& bench, const Route& route) {
  const protocols::Protocol protocol = shipped_protocol(route.file);
  const protocols::Rig rig = simulated_rig();
  Taps taps{.route = route};
  for (const std::string& material : route.materials()) {
    for (const char* const fixations : {"two", "four"}) {
      const std::string name = fmt::format("{}_{}", material, fixations);
      const auto stimulus = stimulus_with(protocol, protocol.stimulus(name));
      for (const auto& [point, at_m] : stimulus.plate->tapping_points_m) {
        core::tell(bench.progress, fmt::format("{}, {} at {}", route.name, name, point));
        const ScriptedTap tap{stimulus, at_m, tap_speed_m_s, shown_s};
        taps.force.emplace(
            fmt::format("{} {}", name, point),
            tap_force(trace_of(tap, protocol, rig, bench.models).ticks, protocol.rate_hz));
      }
    }
  }
  taps.least_modulus_pa = std::min(protocol.materials.at("mdf")->youngs_modulus_pa,
                                   protocol.materials.at("acrylic")->youngs_modulus_pa);
  taps.aluminium_pa = protocol.materials.at(route.aluminium)->youngs_modulus_pa;
  return taps;
}

enum class Part { whole, low, high };
double share(const TapForce& force, Part part) {
  const double peak_n = part == Part::whole ? force.vibration_n
                        : part == Part::low ? force.low_n
                                            : force.high_n;
  return 100.0 * peak_n / force.penalty_n;
}
const char* describe_part(Part part) {
  return part == Part::whole ? "vibration"
         : part == Part::low ? "vibration below 100 Hz"
                             : "vibration above 100 Hz";
}

// A limit on one part of the vibration at a point of the plates.
struct Question {
  const char* point;
  std::vector<const char*> fixations;
  Part part;
  Measure (*limited)(double, const std::string&, double, const std::string&);
  double limit;
  bool with_aluminium{true};
};

std::vector<Measure> measures(const Taps& taps, const Question& question) {
  std::vector<Measure> all;
  for (const char* const fixations : question.fixations) {
    for (const std::string& material : taps.route.materials()) {
      if (material == taps.route.aluminium && !question.with_aluminium) {
        continue;
      }
      all.push_back(question.limited(
          question.limit,
          fmt::format("{}_{} at {}: {}", material, fixations, question.point,
                      describe_part(question.part)),
          share(taps.at(material, fixations, question.point), question.part), "% of penalty"));
    }
  }
  return all;
}

Claim seen(const std::vector<Taps>& all, Claim claim, const Question& question) {
  for (const Taps& taps : all) {
    const std::string tapped = taps.route.materials().front() + "_" + question.fixations.front();
    claim.methods.push_back({taps.route.name, tap_command(taps.route.file, tapped, question.point),
                             measures(taps, question)});
  }
  return claim;
}

Claim none_at_p1(const std::vector<Taps>& all) {
  return seen(
      all,
      {.name = "p1_no_vibration",
       .section = "section 5.1, Figures 4 and 5",
       .statement = "Tapped at P1, beside a fixed point, almost all of the force is the penalty "
                    "force and no vibration is seen, with two and with four fixations.",
       .rule = visible_rule},
      {"P1", {"two", "four"}, Part::whole, at_most, visible});
}

Claim low_absent_at_p2(const std::vector<Taps>& all) {
  return seen(all,
              {.name = "p2_low_modes_absent",
               .section = "section 5.1, Figures 4 and 5",
               .statement = "Tapped at P2, the middle, no low-frequency modes are seen.",
               .rule = visible_rule + band_rule},
              {"P2", {"two", "four"}, Part::low, at_most, visible});
}

Claim high_seen_at_p2(const std::vector<Taps>& all) {
  return seen(all,
              {.name = "p2_high_modes_seen",
               .section = "section 5.1, Figures 4 and 5",
               .statement = "Tapped at P2, high-frequency modes are well seen.",
               .rule = visible_rule + band_rule},
              {"P2", {"two", "four"}, Part::high, at_least, visible});
}

Claim large_at_p3(const std::vector<Taps>& all) {
  return seen(
      all,
      {.name = "p3_two_large",
       .section = "section 5.1, Figure 4",
       .statement = "Tapped at P3, with two fixations, MDF and acrylic show a large vibration of "
                    "low-frequency modes.",
       .rule = "Large is 5 % of the largest penalty force. " + band_rule},
      {"P3", {"two"}, Part::low, at_least, large, false});
}

Claim low_absent_at_p3(const std::vector<Taps>& all) {
  return seen(
      all,
      {.name = "p3_four_small",
       .section = "section 5.1, Figure 5",
       .statement = "With four fixations P3 is near a fixed point too, and the vibration of "
                    "low-frequency modes is not well seen.",
       .rule = visible_rule + band_rule},
      {"P3", {"four"}, Part::low, at_most, visible});
}

// Aluminium's peak over the larger, or smaller, of the other two.
Measure aluminium_over_others(const Taps& taps, const char* fixations, const char* point, Part part,
                              bool is_largest) {
  const auto peak = [&](const std::string& material) {
    return share(taps.at(material, fixations, point), part);
  };
  const double least = std::min(peak("mdf"), peak("acrylic"));
  const double most = std::max(peak("mdf"), peak("acrylic"));
  const std::string name =
      fmt::format("{}_{} at {}: {} over that of {} of MDF and acrylic", taps.route.aluminium,
                  fixations, point, describe_part(part), is_largest ? "the larger" : "the smaller");
  const double aluminium = peak(taps.route.aluminium);
  return is_largest ? at_least(1.0, name, aluminium / most) : at_most(1.0, name, aluminium / least);
}

Claim most_in_aluminium(const std::vector<Taps>& all) {
  Claim claim{.name = "p2_most_in_aluminium",
              .section = "section 5.1, Figures 4 and 5",
              .statement = "At P2 they are seen most in aluminium.",
              .rule =
                  "Aluminium's vibration above 100 Hz is at least as large as that of the other "
                  "two, with two and with four fixations."};
  for (const Taps& taps : all) {
    Method method{
        taps.route.name, tap_command(taps.route.file, taps.route.aluminium + "_two", "P2"), {}};
    for (const char* const fixations : {"two", "four"}) {
      method.measures.push_back(aluminium_over_others(taps, fixations, "P2", Part::high, true));
    }
    claim.methods.push_back(std::move(method));
  }
  return claim;
}

Claim smaller_in_aluminium(const std::vector<Taps>& all) {
  Claim claim{.name = "p3_two_smaller_in_aluminium",
              .section = "section 5.1, Figure 4",
              .statement =
                  "There the vibration of aluminium is smaller, because its Young's modulus "
                  "is larger.",
              .rule =
                  "Aluminium's vibration is at most as large as that of either of the others, and "
                  "its Young's modulus at least as large."};
  for (const Taps& taps : all) {
    claim.methods.push_back({taps.route.name,
                             tap_command(taps.route.file, taps.route.aluminium + "_two", "P3"),
                             {aluminium_over_others(taps, "two", "P3", Part::whole, false),
                              at_least(1.0, "Young's modulus over the smaller of MDF and acrylic",
                                       taps.aluminium_pa / taps.least_modulus_pa)}});
  }
  return claim;
}

// The figures: of each route the whole force on one scale, the vibration alone on another.
Drawing waveforms(const Taps& taps, const char* fixations) {
  const bool is_open =
      std::string_view{fixations} == "two" && !taps.route.differs_in_aluminium_only;
  Drawing drawing{fmt::format("{}, {} fixations", taps.route.name, fixations), {}, is_open};
  for (const std::string& material : taps.route.materials()) {
    for (const char* const point : {"P1", "P2", "P3"}) {
      drawing.svg.push_back(
          force_svg(taps.at(material, fixations, point), fmt::format("{}, {}", material, point)));
    }
  }
  return drawing;
}
}  // namespace

std::vector<Claim> feedback_forces(Bench& bench) {
  std::vector<Taps> all;
  for (const Route& route : bench.plates) {
    all.push_back(taps_of(bench, route));
  }
  std::vector<Claim> claims{
      none_at_p1(all),  low_absent_at_p2(all),     high_seen_at_p2(all), most_in_aluminium(all),
      large_at_p3(all), smaller_in_aluminium(all), low_absent_at_p3(all)};
  for (Claim& claim : claims) {
    claim.unknown_input = "where P1, P2 and P3 are, and which corners two fixations hold";
  }
  for (const Taps& taps : all) {
    claims.front().drawings.push_back(waveforms(taps, "two"));
    claims.front().drawings.push_back(waveforms(taps, "four"));
  }
  claims.front().remarks.push_back(fmt::format(
      "Every tap is by the simulated hand at {} m/s, for which the paper gives no number; "
      "vibration and penalty force both grow with the speed, so their ratio hardly depends on it.",
      tap_speed_m_s));
  return claims;
}
}  // namespace tapstudy::runner
