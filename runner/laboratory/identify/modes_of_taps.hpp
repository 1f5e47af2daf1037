#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runner/laboratory/identify/tap_identification.hpp"
#include "runner/laboratory/identify/tap_remarks.hpp"
namespace tapstudy::runner {
// Throws InvalidInput where more is asked for than the rate allows.
void check_band(const TapQuestion& question, double rate_hz);
// The band in which modes are sought: what was asked for, or from 10 Hz to somewhat above the
// highest peak of the decays' spectra, at most 2000 Hz or the protocol's band limit and as far as
// the rate allows before sensors' own filters act. Adds a remark if more than 1 % of the decays'
// energy lies outside.
analysis::Band modal_band(const TapQuestion& question, const std::vector<IdentifiedTap>& taps,
                          std::optional<double> band_limit_hz, std::vector<std::string>& remarks);
// The same for a tap's sinusoid, up to 1000 Hz or as far as the rate allows.
analysis::Band band_of_sinusoid(const analysis::Band& sought, double rate_hz);

// Sets the taps' modes and returns those over all taps and channels, ascending frequency, with
// what each of them is. Steady tones that only some taps show are fitted in the others, too, and
// close modes are told apart by all taps together, or joined where nothing tells them apart. Tones
// within a mode's width are taken out of the taps first, as their rest shows them. Taps
// that are too short for the band are left out, with a remark: none may be left.
std::vector<analysis::RepeatedMode> modes_over_all(const analysis::Band& band,
                                                   std::vector<IdentifiedTap>& taps,
                                                   analysis::Quantity quantity,
                                                   TapRemarks& remarks);
}  // namespace tapstudy::runner
