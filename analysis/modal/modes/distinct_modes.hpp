#pragma once
#include <vector>

#include "analysis/modal/modes/close_modes.hpp"
namespace tapstudy::analysis {
// Neighbours that are one mode become one. From the strongest on, all that the taps show within
// reach of a mode is compared with a single mode whose frequency and damping follow its amplitude
// (resting_pole_fit.hpp), over all taps at once, by Schwarz's criterion: if that is no worse, they
// are one mode, whose estimates are those at rest, with jackknife intervals over impacts.
// Neighbours stay as they are if all taps together told them apart and the single mode fits worse.
// rests: what the sensors show before the taps; a dependence on the amplitude that explains no more
// than what moves the mode there is none.
std::vector<RepeatedMode> distinct_modes(const std::vector<FreeDecay>& decays,
                                         const std::vector<int>& impacts, const Band& band,
                                         const ModesOfTaps& found,
                                         const std::vector<FreeDecay>& rests = {});

// How long after these decays begin they are free: 0, or up to 12 ms later, while reflections of
// the blow arrive or the striker still touches. Each of the six strongest modes, which may follow
// its amplitude, then explains its neighbourhood as well as later on (standard deviations within 15
// %).
double settled_after_s(const std::vector<FreeDecay>& decays, const std::vector<int>& impacts,
                       const Band& band, const ModesOfTaps& found);
// A blow with its reflections and the striker's touch.
inline constexpr double blow_s = 0.012;
// Agreed modes, no more than 24 dB below the strongest at the blow, or, within 15 % of a stronger
// one, 20 dB where decays begin, that had died away by then (by a third at least) and are missing
// among what the later decays show: no agreed mode later lies within their half-power bandwidth and
// its own. Their intervals are wider by what reflections may do.
std::vector<RepeatedMode> died_before(double after_s, const std::vector<RepeatedMode>& first,
                                      const std::vector<RepeatedMode>& later);
// Beside the later ones, instead of what doubtful remainders of them are left there, unless one is
// agreed there by now. Ascending.
void add_died(const std::vector<RepeatedMode>& died, std::vector<RepeatedMode>& later);
FreeDecay begun_later(const FreeDecay& decay, double after_s);
}  // namespace tapstudy::analysis
