#pragma once
#include "analysis/recordings/recording.hpp"
namespace tapstudy::analysis {
// One tap, in sample numbers: the impact, and [begin, end) in which the structure rings freely.
struct Tap {
  int impact{};  // number in the recording, from 1
  std::size_t onset{};
  std::size_t begin{};
  std::size_t end{};
};

struct TapFinding {
  double skip_s{0.002};  // after the largest value near the impact: the contact
  double max_s{2.0};     // of free decay
};

struct FoundTaps {
  std::vector<Tap> taps;
  int impacts{};                     // those left out included
  double noise_rms{};                // of the quietest fifth of the recording
  std::vector<std::string> remarks;  // what was left out, and why
};

// Energies of frames of 2 ms (8 samples at least) against the noise floor, the 20 % quantile of
// the energies of ten frames each. An impact exceeds it tenfold, and twice what earlier taps left,
// taken to fall by e in 50 ms at the slowest, and is no continuation of what rang before: a linear
// prediction errs there four times as much as a quarter of a second before (in energy). Two impacts
// within 30 ms are one. A free decay ends at the next impact, where its energy has fallen to twice
// the noise floor, or after max_s. It begins after samples at the rails of the sensor
// (rail_samples), if there are any. Decays below 64 samples or 20 ms are left out with a remark.
// Throws InvalidInput with the file if none is left.
FoundTaps find_taps(const Recording& recording, const TapFinding& finding);
// The same where the sample numbers of the impacts are known: from the force, of which nothing
// rings on.
FoundTaps taps_at(const std::vector<std::size_t>& onsets, const Recording& recording,
                  const TapFinding& finding);
// Of the impacts that find_taps finds; throws InvalidInput if there is none.
std::vector<std::size_t> impact_onsets(const Recording& recording);

// Sample numbers where the sensor was at its limit: runs of three and more samples at the largest
// or smallest value of all into which the signal does not run smoothly (next to it, it moves by
// more than three steps of the converter's resolution).
std::vector<std::size_t> rail_samples(const std::vector<double>& samples);
}  // namespace tapstudy::analysis
