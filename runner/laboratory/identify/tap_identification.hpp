#pragma once
#include <optional>
#include <string>
#include <vector>

#include "analysis/modal/decay/decaying_sinusoid_fit.hpp"
#include "analysis/modal/modes/rayleigh_fit.hpp"
#include "analysis/modal/modes/repeated_modes.hpp"
#include "analysis/modal/modes/tap_modes.hpp"
#include "analysis/modal/recording/taps.hpp"
#include "runner/laboratory/identify/model_comparison.hpp"
#include "runner/terminal/logging.hpp"
namespace tapstudy::runner {
// The request for an identification from recordings of real taps.
struct TapQuestion {
  std::vector<std::string> recordings;
  analysis::ReadingOptions reading;  // its column left open
  double rate_error{0.001};          // by how much of it the recordings' rate may be wrong
  std::vector<std::string> columns;  // of each recording, as ReadingOptions::column; empty: one
  std::string force_column;          // of what struck [N], likewise; may be empty
  analysis::Quantity quantity{analysis::Quantity::acceleration};
  std::optional<double> scale;  // SI units in one of the recordings'; unset: they are in SI units
  analysis::TapFinding finding;
  std::optional<analysis::Band> band;  // unset: it follows the recording
  std::string speeds;  // CSV with a column speed_m_s, a row for each tap; may be empty
  std::string places;  // CSV with columns x_m and y_m, likewise; may be empty
  std::optional<Eigen::Vector2d> at_m;  // where was tapped, plate frame: to be played back
  std::string protocol;                 // with a stimulus, or both empty
  std::string stimulus;
};

// The force of an impact.
struct ImpactForce {
  double impulse_n_s{};  // above 0
  double centre_s{};     // when, by the centroid of the force
  bool is_clipped{};     // at its sensor's limit
};

struct IdentifiedTap {
  std::string file;
  std::string channel;
  analysis::Tap tap;
  int impact{};                   // over all recordings, from 1; the same in all channels
  double time_s{};                // of the impact
  double noise_rms{};             // of the recording
  bool is_clipped{};              // somewhere from the impact on
  analysis::FreeDecay decay;      // in the recording's unit, about its mean
  analysis::FreeDecay whole;      // from the impact on
  analysis::FreeDecay rest;       // before the impact, since the tap before; may be empty
  analysis::FreeDecay quiet;      // that, or where it is short what follows the decay
  double quiet_s{};               // when it begins
  double struck_s{};              // and how long after the last blow before it; 0: none was
  std::vector<double> beside_hz;  // steady tones that are fitted beside its modes
  analysis::TapModes modes;
  std::optional<analysis::FittedSinusoid> sinusoid;  // none of clipped ones
  std::optional<double> speed_m_s;
  std::optional<ImpactForce> force;  // where it was recorded
  std::optional<std::size_t> place;  // that was tapped: index into TapIdentification::places_m
};

struct SinusoidLaw {
  analysis::Estimate decay_per_s;
  analysis::Estimate frequency_hz;
  double explained{};       // of the taps' energy, on average
  bool is_of_one_sensor{};  // of several no amplitude: each has its own
  std::optional<analysis::Estimate> amplitude_per_speed;  // SI unit of the quantity per m/s
  std::optional<analysis::AmplitudeLine> line;            // amplitude = offset + slope * speed
  std::optional<double> amplitude_n_s_per_m;  // as the protocol's finger makes a force of it
};

// Modes, and what a protocol can take of them, whatever was measured.
struct ModalFindings {
  std::string source;    // "3 taps, acceleration, 10 to 300 Hz"
  std::string stimulus;  // of the protocol; may be empty
  std::vector<analysis::RepeatedMode> modes;
  std::vector<std::size_t> agreed;                // indices into modes: those that are listed
  std::vector<std::string> others;                // sentences: what is not listed, one a kind
  std::optional<analysis::RayleighFit> rayleigh;  // of the agreed modes
  std::optional<SinusoidLaw> sinusoid;
  std::optional<ModelComparison> model;
  std::vector<std::string> remarks;
  std::optional<double> loop_rate_hz{};  // of the protocol
};

struct TapIdentification : ModalFindings {
  TapQuestion question;
  analysis::Band band;
  std::vector<IdentifiedTap> taps;
  std::vector<Eigen::Vector2d> places_m;  // that were tapped; empty: not known
  double finger_kg{};                     // of the protocol; 0 without one
};

// Sets `agreed` and `rayleigh` by the modes.
void sum_up_modes(ModalFindings& findings);
// What to say where a model on springs has modes that tell neither them nor its modulus; may be
// empty.
std::vector<std::string> remarks_on_springs(const ModelComparison& model);

// Reads, finds the taps, identifies modes, damping, sinusoid and Young's modulus; intervals include
// the rate's error. Throws
// InvalidInput for what cannot be read, recordings without a tap, a band that does not fit, speeds
// or places that are not as many as impacts; ModelError if the stimulus's model cannot be built.
TapIdentification identify_taps(const TapQuestion& question, Progress& progress);

// Widens the intervals by what a rate that is wrong by up to this share makes of them: frequencies
// and decays are in proportion to the rate, moduli and stiffnesses to its square, beta to its
// inverse; damping ratios do not depend on it.
void include_rate_error(double share, TapIdentification& identified);
}  // namespace tapstudy::runner
