#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/progress.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// Error tolerance. By default the smallest just noticeable differences for vibration at the
// fingerpad: 13 % in frequency, 1.65 dB in level (Israr & Tan 2006, Frequency and amplitude
// discrimination along the kinesthetic-cutaneous continuum).
struct Tolerance {
  double frequency{0.13};  // fraction
  double level_db{1.65};
};

// One way to render a stimulus.
struct Setting {
  core::Meshing mesh;
  double band_limit_hz{};
  core::Integrator integrator{};
  double rate_hz{};
  bool is_protocols{false};  // the protocol's own setting
};

constexpr std::string_view name(core::Integrator integrator) {
  return integrator == core::Integrator::exact ? "exact" : "newmark";
}

// Cost of a setting and its errors against the reference.
struct Evaluation {
  Setting setting;
  int tets{};
  int dofs{};
  int modes{};
  double build_s{};
  double tick_ns{};
  double cost_s{};           // build_s plus CPU time for ten minutes of tapping
  double frequency_error{};  // largest of all modes in the protocol's band, fraction
  int missing_modes{};       // of the reference's in the protocol's band
  int extra_modes{};         // that the reference has not
  double level_error_db{};   // of the felt vibration in any third octave, maximum over all tapping
                             // points, including the attenuation by the zero-order hold
  double decay_error_db{};   // of the level after 40 ms beside the level before, likewise
  double force_error{};      // |f - f_reference| / |f_reference| over 0.3 s (L2), likewise
  bool is_on_front{false};   // no cheaper setting has a smaller force error, and silence has not
  bool is_inside_tolerance{false};
  bool is_worse_than_silence() const { return !(force_error < 1.0); }
};

// The finest mesh, of order 2, with the widest band tried and the exact integrator; and a measure
// of its own convergence.
struct Reference {
  int tets{};
  int dofs{};
  double band_limit_hz{};
  int modes{};
  double build_s{};
  int coarser_tets{};
  double moved_frequency{};  // relative to the next coarser mesh
  double moved_force{};      // likewise
  double moved_level_db{};   // likewise, in any third octave
  double force_beyond{};     // fraction of the force up to twice the band that the reference omits;
                             // 0 if there are no damping ratios for it
  bool has_settled(const Tolerance& tolerance) const {
    return moved_frequency <= 0.25 * tolerance.frequency &&
           moved_level_db <= 0.5 * tolerance.level_db;
  }
};

// A mesh and band for which no model could be built.
struct Refused {
  core::Meshing mesh;
  double band_limit_hz{};
  bool is_protocols{false};
  std::string words;  // why
};

// The extent of the search: everything, or all but the finest mesh.
enum class Effort { full, quick };

struct Trade {
  std::string stimulus;
  Tolerance tolerance;
  Reference reference;
  std::vector<Evaluation> settings;  // cheapest first
  std::vector<Refused> refused;
  int cheapest{-1};  // inside the tolerance; -1: there is none, or the reference has not settled
};

// Builds the stimulus's plate with some twenty settings, and evaluates each with both integrators
// and up to three rates. A finger strikes every tapping point at the simulated participants' speed.
// The progress names the model being built and an estimate of the time left.
// Throws InvalidInput if the stimulus does not vibrate, ModelError if the reference cannot be
// built.
Trade measure_trade(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                    const Tolerance& tolerance, Effort effort = Effort::full,
                    const core::ProgressHook& progress = {});

// Marks the Pareto front of cost and force error, and the cheapest setting within the tolerance.
void mark_pareto_front(Trade& trade);
}  // namespace tapstudy::runner
