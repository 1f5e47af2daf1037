#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/progress_hook.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// Error tolerance. By default the smallest just noticeable differences for vibration felt through a
// stylus or tool: 18 % in frequency, 2.2 dB in amplitude (Israr & Tan 2006, Frequency and amplitude
// discrimination along the kinesthetic-cutaneous continuum).
struct Tolerance {
  double frequency{0.18};  // fraction
  double level_db{2.2};
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
  double frequency_error{};  // largest of all modes in the setting's band, fraction
  double level_error_db{};   // of the vibration's RMS, maximum over all tapping points, including
                             // the attenuation by the zero-order hold of the output
  double force_error{};      // |f - f_reference| / |f_reference| over 0.3 s (L2), likewise
  bool is_on_front{false};   // no cheaper setting has a smaller force error
  bool is_inside_tolerance{false};
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
  double force_beyond{};     // fraction of the force up to twice the band that the reference omits;
                             // 0 if there are no damping ratios for it
  bool has_settled(const Tolerance& tolerance) const {
    return moved_frequency <= 0.25 * tolerance.frequency;
  }
};

// A mesh and band for which no model could be built.
struct Refused {
  core::Meshing mesh;
  double band_limit_hz{};
  bool is_protocols{false};
  std::string words;  // why
};

struct Trade {
  std::string stimulus;
  Tolerance tolerance;
  Reference reference;
  std::vector<Evaluation> settings;  // cheapest first
  std::vector<Refused> refused;
  int cheapest{-1};  // inside the tolerance; -1: there is none
};

// Builds the stimulus's plate with some twenty settings, and evaluates each with both integrators
// and up to three rates. A finger strikes every tapping point at the simulated participants' speed.
// Throws InvalidInput if the stimulus does not vibrate, ModelError if the reference cannot be
// built.
Trade measure_trade(const protocols::Protocol& protocol, const protocols::Stimulus& stimulus,
                    const Tolerance& tolerance, const core::ProgressHook& progress = {});

// Marks the Pareto front of cost and force error, and the cheapest setting within the tolerance.
void mark_pareto_front(Trade& trade);
}  // namespace tapstudy::runner
