#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/decay/decay_fit.hpp"
#include "analysis/modal/decay/pole_estimation.hpp"
namespace tapstudy::analysis {
// Chi-squared of the two parts of an amplitude, below which a mode is not there.
inline constexpr double min_significance = 25.0;

// agreed: both methods find it, and it is stable over orders; line: it does not decay, and is no
// mode but hum or another steady tone; background: what moves too slowly for a tap's decay to tell;
// combination: a multiple of a stronger mode, or a sum or difference of stronger modes.
enum class Standing { agreed, doubtful, line, background, combination };
const char* name(Standing standing);

struct TapMode {
  FittedMode fitted;
  Standing standing{Standing::doubtful};
  std::string why;  // why doubtful, which line, or that it took all taps to tell it from another
  std::optional<Pole> by_rational_fit;  // unset: not found so
  int stable_orders{};                  // 0: not found by the matrix pencil
};

struct TapModes {
  std::vector<TapMode> modes;    // inside the band, ascending frequency
  MatrixPencil pencil;           // whose stabilisation diagram can be drawn
  BandSpectrum spectrum;         // of a band somewhat wider than asked for
  DecayFit fit;                  // of all modes in it
  std::vector<double> lines_hz;  // steady tones that took part in the fit
};

// Modes of one tap. Poles that are stable by the matrix pencil and those by vector fitting are
// fitted together (fit_decay), in a band up to a quarter wider, so that a mode just outside is not
// felt inside; poles whose amplitude is not significant (chi-squared below 25) are dropped, the
// weakest first. A remaining mode is agreed if both methods found it: frequencies within 1 % (a
// sixth of the half-power bandwidth or four standard errors if that is more), damping ratios within
// a quarter (or 0.003, or four standard errors). What does not fall significantly over the tap is
// a line. So is what falls by less than 14 %, or by less than 40 % at a harmonic of the mains,
// unless the sensor shows nothing there at rest (rest: before the tap; empty: not known). Throws
// InvalidInput for decays that are too short.
TapModes identify_modes(const FreeDecay& decay, const Band& band, const FreeDecay& rest = {});

// The same tap's modes fitted again, to a decay that may have been freed from others, beside steady
// tones. Throws InvalidInput for a decay too short for that.
TapModes with_lines(const TapModes& before, const FreeDecay& decay, const Band& band,
                    const std::vector<double>& lines_hz, const FreeDecay& rest = {});

// A decay without what the fit says of these modes of its tap. What a mode leaves in another part
// of a band is smooth there, but no polynomial: it would be felt in the damping of modes there.
FreeDecay without_modes(FreeDecay decay, const std::vector<TapMode>& modes);

// The largest number of modes that can be fitted to a spectrum beside lines.
std::size_t max_mode_count(const BandSpectrum& spectrum, const std::vector<double>& lines_hz);

// Lines that some taps show and this one does not, within 1 % of any mode of its own: beside a mode
// of nearly the same frequency hum may go unnoticed, and falsify its damping. Each once.
std::vector<double> missed_lines(const TapModes& tap, const std::vector<TapModes>& taps);

// Within 1 %, as above.
bool is_among_lines(double frequency_hz, const std::vector<double>& lines_hz);

// One tap's modes of several parts of a band, as if they had been found together. Of one part: that
// part.
TapModes joined(const FreeDecay& decay, const Band& band, const std::vector<TapModes>& parts);
}  // namespace tapstudy::analysis
