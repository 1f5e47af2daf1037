#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/document/cells.hpp"
#include "analysis/report/document/sections.hpp"
#include "analysis/report/study/rendered_taps.hpp"
namespace tapstudy::analysis {
// All taps of one participant that count.
struct TapsOfParticipant {
  std::vector<double> speeds_m_s;
  std::vector<double> peaks_n;  // of the commanded force
  double contact_s{};           // of all together
};

// How participants tapped, each by the medians of their taps, and the means of these over
// participants with a 95 % interval by t: how strong somebody taps is a property of the person.
ReportTable participants_taps_table(const std::map<std::string, TapsOfParticipant>& participants);

// What is known of the finite element model that rendered a stimulus.
struct RenderedModel {
  std::vector<double> frequencies_hz;  // of its modes in the band, ascending
  std::vector<double> damping_ratios;
  int order{};
  // "2 instead of 1.414", of each body whose mesher was given a larger radius-edge ratio than asked
  // for; empty: none.
  std::string relaxed_radius_edge_ratio;
  int nodes{};
  int tets{};
  double worst_residual{};  // of the eigenpairs
  std::string dropped;      // "143 Hz (-92 dB)": modes in the band that are not rendered
  // The largest estimated relative error of a frequency, by elements of the next order; unset: not
  // estimated, or there is no mode.
  std::optional<double> estimated_error{};
};

// A stimulus in words, as the protocol has it.
struct RenderedStimulus {
  std::string name;
  std::string label;
  std::string plate;
  std::string size;
  std::string material;
  std::vector<double> youngs_moduli_pa;  // of an orthotropic material along its axes; at least one
  double density_kg_per_m3{};
  std::string fixation;
  std::string technique;
  bool needs_model{};
  bool varies{};                         // the model is of its own values
  std::optional<RenderedModel> model{};  // unset: none is cached, or none needed
};

// The taps nearest to one tapping point.
struct PointTaps {
  std::string point;
  TapStatistics taps;
  std::vector<double> distances_m;  // of each impact from the point, along the plate
};

struct StimulusTaps {
  TapStatistics all;
  std::vector<PointTaps> points;  // of the protocol, in its order
};

struct RenderedStudy {
  std::vector<RenderedStimulus> stimuli;
  std::vector<StimulusTaps> taps;                           // as many
  std::map<std::string, TapsOfParticipant> participants{};  // by id
  std::int64_t trials{};                                    // that count
  std::int64_t traced_trials{};                             // of these, with a trace
};

// What was rendered: the stimuli and their models, and of every tap that counts the force after the
// impact, its spectrum, speed and peak. Tables rendered_stimuli, rendered_models, rendered_modes,
// rendered_taps, rendered_participants, rendered_forces, rendered_points, rendered_waveforms,
// rendered_spectra.
ReportSection rendered_section(const RenderedStudy& study);

// Those of rendered_section: of every stimulus the distribution of speed and peak force, and the
// waveform and spectrum at the point where most is added to the contact spring; those at other
// points are folded. Axes are the same for all stimuli at one point.
void add_rendered_charts(const RenderedStudy& study, ReportSection& section);

// Fewer taps are no mean to be drawn.
inline constexpr std::int64_t least_drawn_taps = 3;
}  // namespace tapstudy::analysis
