#pragma once
#include <functional>
#include <string>
#include <vector>

#include "analysis/modal/modes/repeated_modes.hpp"
namespace tapstudy::analysis {
// Below so many periods in a decay's length frequency and damping cannot be told from a drift.
inline constexpr double min_periods = 3.0;
// The widest interval of a mode's frequency, of the frequency.
inline constexpr double widest_frequency = 0.1;

// What fewer taps show than this share of those that show the most is certain in none: a mode's
// nodes are lines, which few places lie on.
inline constexpr double least_share_of_taps = 1.0 / 3.0;

// What is listed as a mode is certain to be one: agreed ones become doubtful whose damping interval
// holds 0 or whose frequency interval is wider than widest_frequency, with a reason, those that
// few taps show (least_share_of_taps), and those that
// are the blow's own pulse as likely: they die away in fewer than min_periods and sooner than a
// blow is over (blow_s). What makes fewer than min_periods in a decay of this length becomes
// background (unless it is a line), and so does what grows below the weakest mode's frequency.
void judge_certainty(double decay_s, std::vector<RepeatedMode>& modes);

// Of a single decay nothing tells a mode from what another one's large motion adds around it. Of
// one impact, agreed modes that no more than one sensor shows become doubtful if they are
// - 20 dB weaker than another within a factor of 1.5 of their frequency, or, beside other sensors,
//   than the strongest;
// - within both bandwidths of another that more sensors show, or that is stronger and dies away
//   series_ratio times more slowly;
// - 10 dB weaker than another that a motion below the band (below_hz; 0: none) would move there, by
//   once or twice its frequency;
// - over by a factor of e in one period.
void judge_single_decay(std::size_t sensors, double below_hz, std::vector<RepeatedMode>& modes);

// The amplitude of one tone with the power that a sensor shows at rest around a frequency (from two
// thirds to one and a half of it); 0 where too short to tell.
double amplitude_at(double frequency_hz, const FreeDecay& rest);
// What is below 200 Hz and at least half as strong at rest, before the taps, is no answer to them
// but background.
void mark_background(const std::vector<FreeDecay>& rests, std::vector<RepeatedMode>& modes);

// The modal assurance of the shapes of two modes, by their indices.
using Likeness = std::function<double(std::size_t, std::size_t)>;

// Modes that are made by stronger ones: where the motion's products reach the sensor (a joint, a
// contact, an overdriven amplifier), the products of two decaying motions decay by the sum of their
// rates. What lies at a multiple n f of one stronger mode, or at f ± n g of two, decays at that
// rate, both within the intervals of all of them or combination_tolerance, and is weaker by
// combination_weakness, is a combination, unless it rings longer than what would make it or the
// other sideband, f ∓ n g, is not seen. A slow motion g that modulates a fast one need only be
// stronger as a displacement, of which `derivatives` were measured (2: acceleration); the sidebands
// move as the fast one does, where shapes are known (likeness at least like_carrier). So are sums
// and differences of three stronger modes, f ± g ± h, of which a second one is seen. Modes in
// ascending frequency.
inline constexpr double like_carrier = 0.5;
void mark_combinations(std::vector<RepeatedMode>& modes, int derivatives = 0,
                       const Likeness& likeness = {});

// What is not listed among the modes, one sentence a kind: "11 components below 40 Hz: hum or
// handling".
std::vector<std::string> summaries_of_others(const std::vector<RepeatedMode>& modes);
}  // namespace tapstudy::analysis
