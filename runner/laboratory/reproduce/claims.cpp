#include "runner/laboratory/reproduce/claims.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "analysis/report/document/cells.hpp"
#include "core/error.hpp"
#include "runner/build_info/build_info.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
std::string with_unit(double value, const std::string& unit) {
  return analysis::rounded(value) + (unit.empty() ? "" : " " + unit);
}

std::string missed(const Measure& measure) {
  return fmt::format("{} is {}, not {}", measure.name, describe_value(measure),
                     describe_limits(measure));
}

std::string missed(const Method& method) {
  constexpr std::size_t most = 3;  // the table has all
  std::vector<std::string> words;
  for (const Measure& measure : method.measures) {
    if (!measure.holds()) {
      words.push_back(missed(measure));
    }
  }
  const std::size_t more = words.size() > most ? words.size() - most : 0;
  words.resize(words.size() - more);
  return fmt::format("{}: {}{}", method.name, fmt::join(words, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : "");
}
}  // namespace

bool Measure::holds() const {
  return !is_judged() ||
         (value >= at_least.value_or(-HUGE_VAL) && value <= at_most.value_or(HUGE_VAL));
}

Measure at_least(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, limit, {}};
}
Measure at_most(double limit, const std::string& name, double value, const std::string& unit) {
  return {name, value, unit, {}, limit};
}
Measure within(double low, double high, const std::string& name, double value,
               const std::string& unit) {
  return {name, value, unit, low, high};
}
Measure shown(const std::string& name, double value, const std::string& unit) {
  return {name, value, unit};
}

double difference_percent(double value, double printed) {
  return 100.0 * std::abs(value / printed - 1.0);
}

std::string describe_value(const Measure& measure) {
  return with_unit(measure.value, measure.unit);
}

std::string describe_limits(const Measure& measure) {
  const auto& low = measure.at_least;
  const auto& high = measure.at_most;
  if (low && high) {
    return fmt::format("between {} and {}", analysis::rounded(*low),
                       with_unit(*high, measure.unit));
  }
  if (low) {
    return "at least " + with_unit(*low, measure.unit);
  }
  return high ? "at most " + with_unit(*high, measure.unit) : "";
}

bool Method::judges() const {
  return std::ranges::any_of(measures, &Measure::is_judged);
}

bool Method::confirms() const {
  return judges() && std::ranges::all_of(measures, &Measure::holds);
}

std::string_view name(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::confirmed:
      return "true";
    case ClaimVerdict::refuted:
      return "false";
    case ClaimVerdict::shown:
      return "shown";
    case ClaimVerdict::depends:
      break;
  }
  return "depends";
}

ClaimVerdict Claim::verdict() const {
  const auto judging = std::ranges::count_if(methods, &Method::judges);
  const auto confirming = std::ranges::count_if(methods, &Method::confirms);
  if (judging == 0) {
    return ClaimVerdict::shown;
  }
  if (!unknown_input.empty() || (confirming > 0 && confirming < judging)) {
    return ClaimVerdict::depends;
  }
  return confirming == 0 ? ClaimVerdict::refuted : ClaimVerdict::confirmed;
}

std::vector<std::string> Claim::reasons() const {
  std::vector<std::string> confirming;
  std::vector<std::string> others;
  for (const Method& method : methods) {
    if (method.confirms()) {
      confirming.push_back(method.name);
    } else {
      others.push_back(method.judges()
                           ? fmt::format("Does not hold {}.", missed(method))
                           : fmt::format("Shown {}: no judgement of the paper.", method.name));
    }
  }
  if (!confirming.empty()) {
    others.insert(others.begin(), fmt::format("Holds {}.", fmt::join(confirming, "; ")));
  }
  if (!unknown_input.empty()) {
    others.insert(others.begin(),
                  fmt::format("Depends on what the paper does not give: {}.", unknown_input));
  }
  return others;
}

const std::vector<ClaimGroup>& claim_groups() {
  static const std::vector<ClaimGroup> groups{
      {"plate", "The plate model: Table 1", &plate_model},
      {"modes", "The modes below 300 Hz", &mode_count},
      {"shapes", "The shape of the vibration: Figure 3", &mode_shapes},
      {"forces", "The feedback force: Figures 4 and 5", &feedback_forces},
      {"step", "The time of a step", &step_time},
      {"mass", "The finger's mass", &finger_mass},
      {"finger", "The finger's vibration", &finger_vibration},
      {"table2", "Structure and material: Table 2", &discrimination},
      {"reality", "Which technique is most real", &reality},
  };
  return groups;
}

std::vector<std::string> claim_group_names() {
  std::vector<std::string> names;
  for (const ClaimGroup& group : claim_groups()) {
    names.emplace_back(group.name);
  }
  return names;
}

std::vector<ClaimGroup> claim_groups_named(const std::vector<std::string>& names) {
  std::vector<ClaimGroup> groups;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(claim_groups(), name, &ClaimGroup::name);
    if (found == claim_groups().end()) {
      throw core::InvalidInput{fmt::format("--only: '{}' is not a group of claims (one of: {})",
                                           name, fmt::join(claim_group_names(), ", "))};
    }
    groups.push_back(*found);
  }
  return groups.empty() ? claim_groups() : groups;
}

const std::vector<NotReproducible>& not_reproducible() {
  static const std::vector<NotReproducible> list{
      {"Table 1", "Frequencies and damping of the real plates.",
       "The damping ratios were fitted by eye to recordings that are not published. `identify` "
       "finds them in recordings of real taps."},
      {"Figure 2", "The mesh itself.",
       "It is drawn, not listed; the settings of TetGen are not given, and a mesh of its numbers "
       "of elements and nodes did not come out of any setting tried."},
      {"Figures 4 and 5", "The waveforms tick by tick.",
       "Neither the speed of the taps nor the places P1, P2 and P3 are given, nor which corners "
       "two fixations hold. The figures are made with taps of 0.3 m/s, on which shapes do not "
       "depend."},
      {"section 5", "With 58 g the feeling is similar to that of real plates.",
       "It is what users said. What can be computed is how far levels lie apart, above."},
      {"section 5.2.1", "Which plate people take a virtual one for.",
       "A simulated observer with one free parameter is not a person. `run` does the study with "
       "people."},
      {"section 5.2.3", "The acceleration of a finger while it taps, Figure 7.",
       "It is a measurement of one finger, shown as a drawing without its data."},
      {"section 7",
       "The haptic pointer moved around three times slower than the fingers that tap real "
       "plates.",
       "Speed is an input of the simulated hand. In studies with people tapstudy stores the speed "
       "of each impact on virtual plates; taps on real ones have to be measured."},
      {"section 5", "The device presents vibration of up to 300 Hz.",
       "It is a property of the SPIDAR-G6, which a program cannot know: a rig file states it."},
  };
  return list;
}

namespace {
std::string processor_name() {
  std::ifstream file{"/proc/cpuinfo"};
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "an unknown processor";
}
}  // namespace

Reproduction reproduce(Bench& bench, const std::vector<std::string>& only) {
  const std::vector<ClaimGroup> groups = claim_groups_named(only);
  Reproduction all;
  all.seed = bench.seed;
  all.effort = bench.effort;
  all.only = only;
  all.program = fmt::format("tapstudy {} ({})", program_version(), git_hash());
  all.machine = processor_name();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    stop_if_asked();
    say("{} of {}: {}\n", i + 1, groups.size(), groups[i].title);
    Progress progress{std::string{groups[i].title}};
    bench.progress = progress.hook();
    all.groups.push_back({std::string{groups[i].title}, groups[i].measure(bench)});
    bench.progress = {};
  }
  all.not_reproducible = not_reproducible();
  return all;
}
}  // namespace tapstudy::runner
