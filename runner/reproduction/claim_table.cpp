#include "runner/reproduction/claim_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
namespace tapstudy::runner {
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
}  // namespace tapstudy::runner
