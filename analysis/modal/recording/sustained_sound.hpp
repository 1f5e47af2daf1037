#pragma once
#include <vector>

#include "analysis/modal/recording/taps.hpp"
namespace tapstudy::analysis {
// Two measures that tell speech and music from taps. A blow gives a body all its energy at once,
// and the body keeps its frequencies: where some of several sounds swell and most of what is heard
// has many pitches, nothing was tapped. Either alone is no proof: modes that beat swell, too, and a
// cymbal has many pitches.
struct SustainedSound {
  int judged{};  // impacts that no other one follows too soon
  int swells{};  // how often they become louder than their first 40 ms, or as loud again as before
  int tones{};   // that most of the decays' strongest components need, each within 3 %

  bool is_sustained() const;
};
// Of a recording above 2000 samples a second; of others nothing is judged.
SustainedSound sustained_sound(const Recording& recording, const std::vector<Impact>& impacts);
}  // namespace tapstudy::analysis
