#pragma once
#include <vector>

#include "analysis/modal/decay/free_decay.hpp"
namespace tapstudy::analysis {
// What is 26 dB weaker than the strongest mode at the beginning of a decay is not sought.
inline constexpr double weakest_sought = 0.05;

// The highest frequency at which the beginnings of these decays (10 ms, so that modes that die away
// soon count as much as those that ring on; below 1000 Hz also 40 ms, which tell more of them) have
// a spectral peak, no weaker than weakest_sought times the largest, and three times what is left
// there at the end of the decay (1.5 times for one of 15 % of the largest or more: a decay may
// be cut at the next tap long before it is over). Of several decays the 80 % quantile: a click in
// one of them is not the structure's. 0 if none has a peak. The decays are not empty.
double highest_peak_hz(const std::vector<FreeDecay>& decays, double low_hz);

// The energy of the decays beside a band.
struct EnergyOutside {
  double share{};    // of all above low_hz
  double peak_hz{};  // where most of it is
};
EnergyOutside energy_outside(const std::vector<FreeDecay>& decays, const Band& band, double low_hz);

// Where a band that is to hold the decays' modes ends: 1.25 times the highest peak, at least 100
// Hz, and so far that it holds half of the energy above low_hz.
double band_end_hz(const std::vector<FreeDecay>& decays, double low_hz);

// Parts of a wide band in which modes are sought one after another: up to 1000 Hz, then half
// octaves, each edge where the decays have least energy near there. A fit's cost grows with the
// cube of what is in it. Rates of the decays are high enough for the band.
std::vector<Band> parts_of(const Band& band, const std::vector<FreeDecay>& decays);
// A decay until what it has in a part of the band has died away (no bin of 50 ms, or of longer
// where the part is low or narrow, has thirty times the power of the last three of these), and
// above 1000 Hz no longer than 1000 periods: what follows is noise, which costs time and hides
// nothing.
FreeDecay shortened_for(const Band& part, const FreeDecay& decay);
}  // namespace tapstudy::analysis
