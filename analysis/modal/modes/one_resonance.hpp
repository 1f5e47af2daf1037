#pragma once
#include <vector>

#include "analysis/modal/modes/repeated_modes.hpp"
namespace tapstudy::analysis {
// What a joint, a contact or large motion adds to one mode's decay is a series of exponentials at
// nearly its frequency that die away sooner (Poincaré's normal form, resting_pole_fit.hpp). Their
// amplitudes follow the mode's in every tap and at every sensor, because one shape moves; those of
// another mode do not, where places or sensors differ.
//
// Two components are one resonance if they overlap (half of both half-power bandwidths together
// exceeds the distance; all of them, where one dies away within blow_s; or one is weak, dies away
// sooner and lies within 15 %), one dies away series_ratio
// times as fast as the other or is weaker by 14 dB, and the modal assurance of their
// amplitudes over all decays, but for a quarter that may have been struck twice, is at least
// one_shape. The one with more energy in most decays remains, agreed if
// either was and as many taps show it; the other becomes doubtful, with the reason. Of one tap and
// one sensor nothing tells them apart. Lines and background stay.
inline constexpr double series_ratio = 1.6;
// Of amplitudes a and a^3 over strengths from 0.4 to 1, which are one mode's, it is 0.88.
inline constexpr double one_shape = 0.8;
// The modal assurance of two components' amplitudes over all decays.
double likeness_over(const std::vector<FreeDecay>& decays, const std::vector<RepeatedMode>& modes,
                     std::size_t one, std::size_t other);

void join_resonances(const std::vector<FreeDecay>& decays, std::vector<RepeatedMode>& modes);
}  // namespace tapstudy::analysis
