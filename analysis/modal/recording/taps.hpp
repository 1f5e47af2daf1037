#pragma once
#include "analysis/modal/recording/recording.hpp"
namespace tapstudy::analysis {
// One tap, in sample numbers: the impact, and [begin, end) in which the structure rings freely.
struct Tap {
  int impact{};  // number in the recording, from 1
  std::size_t onset{};
  std::size_t begin{};
  std::size_t end{};
  bool is_struck_again{};  // within 30 ms: `begin` is after the last blow
};

struct TapFinding {
  double skip_s{0.002};  // after the largest value near the impact: the contact
  double max_s{2.0};     // of free decay
};

// What was noticed about one tap.
struct TapRemark {
  double at_s{};
  std::string kind;    // the same words for all taps of which it holds
  std::string detail;  // of this one: a number with its words; may be empty
};
// "the tap at 0.300 s: cut at the next one, after 0.150 s"
std::string sentence(const TapRemark& remark);

struct FoundTaps {
  std::vector<Tap> taps;
  int impacts{};                   // those left out included
  double noise_rms{};              // of the quietest fifth of the recording
  std::vector<TapRemark> remarks;  // what was left out, and why
};

// An impact. Further blows within 30 ms belong to it: `last_blow` is the last of them, or the
// onset.
struct Impact {
  std::size_t onset{};
  std::size_t last_blow{};
};

// Energies of frames of 2 ms (8 samples at least) against the noise floor, the 20 % quantile of
// the energies of ten frames each. An impact exceeds it tenfold, as the errors of a linear
// prediction exceed theirs, or fourfold where none is a hundred times as large (the slow motion of
// a floor is predicted), and twice what earlier taps left,
// taken to fall by e in 50 ms at the slowest, and is no continuation of what rang before: a linear
// prediction errs there four times as much as a quarter of a second before (in energy). Within what
// still rings louder, only an error sixteen times as large tells a new impact. Two impacts within
// 30 ms are one. A free decay ends at the next impact, where its energy has fallen to twice the
// noise floor, or after max_s. A tap whose peak is more than 30 times below that of most taps is
// left out with a remark: a click, or a step nearby. It begins after samples at the rails of the
// sensor (rail_samples), if there are any. Decays below 64 samples or 20 ms are left out with a
// remark. Throws InvalidInput with the file if none is left, and for speech and music
// (sustained_sound.hpp).
FoundTaps find_taps(const Recording& recording, const TapFinding& finding);
// The same where the impacts are known.
FoundTaps taps_at(const std::vector<Impact>& impacts, const Recording& recording,
                  const TapFinding& finding);
// The impacts of a force, of which nothing rings on: each time it leaves its resting value (the
// median) by a tenth of the most that it does, having been back within 3 % for 1 ms. Throws
// InvalidInput as find_taps if there is none.
std::vector<Impact> force_impacts(const Recording& force);
// The state of a channel at rest: its median, and the standard deviation of its quietest fifth.
struct Resting {
  double value{};
  double noise_rms{};
};
Resting resting(const Recording& recording);
// Whether a channel shows what another one tells to be a tap: a frame of it has ten times the
// energy of the channel's noise, as of every impact that is found.
bool shows(const Tap& tap, const Recording& recording, const Resting& at_rest);

// Sample numbers where the sensor was at its limit: runs of three and more samples at the largest
// or smallest value of all into which the signal does not run smoothly (next to it, it moves by
// more than three steps of the converter's resolution); and runs of four and more within three
// times the noise of these values, as a limited amplifier in front of a noisy converter gives them,
// next to which the signal moves by more than six times the noise, and what it does within the run.
std::vector<std::size_t> rail_samples(const std::vector<double>& samples, double noise_rms);

// Sample numbers where samples were dropped: runs of four and more zeros from which the signal is
// away by more than six times its noise and the converter's resolution on both sides. A signal that
// passes through 0 so slowly does not leave it so suddenly.
std::vector<std::size_t> dropped_samples(const std::vector<double>& samples, double noise_rms);
}  // namespace tapstudy::analysis
