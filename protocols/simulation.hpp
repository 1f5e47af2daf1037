#pragma once
#include <string>
#include <vector>

#include "core/settings/hand_body.hpp"
#include "core/techniques/technique.hpp"
namespace tapstudy::protocols {
// Simulated participants, for studies without people.
struct SimulatedTapSettings {
  std::vector<std::string> points;  // names of tapping points, visited in random order
  int taps_per_visit{8};
  int visits{2};             // to each alternative, where there are several
  double scatter_m{0.01};    // standard deviation of the place hit, on the plate
  double speed_m_s{0.3};     // median speed
  double speed_spread{0.2};  // standard deviation of its logarithm
  double dwell_s{0.25};
  double pause_s{0.35};
  double hover_m{0.02};
  double press_m{0.004};
};
struct SimulatedObserverSettings {
  // Internal noise on each felt feature; the default reproduces the accuracies of the paper's
  // Table 2.
  double noise_db{14.0};
  double threshold_n{1e-4};      // force amplitudes well below are not felt
  int familiarisation_taps{24};  // on each real plate, before the study
  std::string reference;         // the stimulus taken as reality, where a task needs one
  // Real plates have no technique: they are remembered as they vibrate by this one, the same for
  // every stimulus of a body.
  const core::Technique* reality{&core::natural_vibration()};
};
// How simulated participants differ: standard deviations between participants.
struct SimulatedPeopleSettings {
  double noise_spread{0.5};       // of the logarithm of the internal noise
  double threshold_spread{0.25};  // of the logarithm of the threshold
  double speed_spread{0.15};      // of the logarithm of the tapping speed
  double bias{0.5};               // towards each answer, in squared units of the internal noise
};
struct Simulation {
  core::HandBody hand;
  SimulatedTapSettings taps;
  SimulatedObserverSettings observer;
  SimulatedPeopleSettings people;
};
}  // namespace tapstudy::protocols
