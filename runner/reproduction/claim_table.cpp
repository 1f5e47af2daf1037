#include "runner/reproduction/claim_table.hpp"
namespace tapstudy::runner {
const std::vector<ClaimGroup>& claim_groups() {
  static const std::vector<ClaimGroup> groups{
      {"The plate model: Table 1", &mode_count},
      {"The shape of the vibration: Figure 3", &mode_shapes},
      {"The feedback force: Figures 4 and 5", &feedback_forces},
      {"The time of a step", &step_time},
      {"The finger's mass", &finger_mass},
      {"The finger's vibration", &finger_vibration},
      {"Structure and material: Table 2", &discrimination},
      {"Which technique is most real", &reality},
  };
  return groups;
}

const std::vector<NotReproducible>& not_reproducible() {
  static const std::vector<NotReproducible> list{
      {"Table 1", "Frequencies and damping of the real plates.",
       "The damping ratios were fitted by eye to recordings that are not published. `identify` "
       "finds "
       "them in recordings of real taps."},
      {"Figure 2", "The mesh itself.",
       "It is drawn, not listed; the settings of TetGen are not given, and a mesh of its numbers "
       "of "
       "elements and nodes did not come out of any setting tried."},
      {"Figures 4 and 5", "The waveforms tick by tick.",
       "Neither the speed of the taps nor the places P1, P2 and P3 are given, nor which corners "
       "two "
       "fixations hold. The figures are made with taps of 0.3 m/s, on which shapes do not depend."},
      {"5", "With 58 g the feeling is similar to that of real plates.",
       "It is what users said. What can be computed is how far levels lie apart, above."},
      {"5.2.1", "Which plate people take a virtual one for.",
       "A simulated observer with one free parameter is no person. `run` does the study with "
       "people."},
      {"5.2.3", "The acceleration of a finger while it taps, Figure 7.",
       "It is a measurement of one finger, shown as a drawing without its data."},
      {"7",
       "The haptic pointer moved around three times slower than the fingers that tap real "
       "plates.",
       "Speed is an input of the simulated hand. In studies with people tapstudy stores the speed "
       "of "
       "each impact on virtual plates; taps on real ones have to be measured."},
      {"5", "The device presents vibration of up to 300 Hz.",
       "It is a property of the SPIDAR-G6, which a program cannot know: a rig file states it."},
  };
  return list;
}
}  // namespace tapstudy::runner
