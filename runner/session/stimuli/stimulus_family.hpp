#pragma once
#include "core/model/body_modes.hpp"
#include "protocols/axes/presented_stimulus.hpp"
namespace tapstudy::runner {
// The members of a stimulus that varies on scaled axes share a body: kappa of the band limit, below
// which its modes lie in the band, is largest in the softest and densest member.

// Values of the scaled axes, the stimulus's own included, with the most and the fewest modes below
// the band limit.
struct BandEnds {
  protocols::AxisValues most;
  protocols::AxisValues fewest;
};
BandEnds band_ends(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus);

// The values of one of its scaled axes, ascending, at which a mode of the body crosses the band
// limit while the other axes keep the stimulus's own: what is felt changes there by a whole mode,
// and by little between.
std::vector<double> band_crossings(const protocols::Protocol& protocol,
                                   const protocols::Stimulus& stimulus,
                                   const protocols::AxisRange& range, const core::BodyModes& body);

// kappa of the band limit in the member with the most modes: its body is solved up to here.
double largest_kappa_rad_per_m(const protocols::Protocol& protocol,
                               const protocols::Stimulus& stimulus);

// All of Poisson's ratios that the stimulus may be presented with.
std::vector<double> poissons_ratios(const protocols::Protocol& protocol,
                                    const protocols::Stimulus& stimulus);

// That every member at these values of the tabled axes has a mode in the band, and a damping that
// fits its modes. Those with the fewest and the most modes are tried: a list of ratios that reaches
// for the most reaches for all, and eq. 13 gives no coefficient below zero for more modes if it
// gives none for fewer, since the ratio of the highest frequency to the lowest only grows. Throws
// ModelError naming the values of the one that cannot be built.
void check_members(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                   const protocols::AxisValues& tabled, const core::BodyModes& body);

// The stiffest contact spring of all members of all stimuli.
double largest_contact_stiffness_n_per_m(const protocols::Protocol& protocol);
}  // namespace tapstudy::runner
