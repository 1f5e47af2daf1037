#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/progress_hook.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// What came of a tap at the edge of what can be asked for.
enum class Outcome {
  dies_out,  // a second after the tap hardly anything is left of the force's swing
  persists,  // it goes on, bounded: no damping, or a chattering contact
  refused,   // the model was not built, and the error says why
  failed     // not finite, or the plate gained energy between impacts
};
std::string_view name(Outcome outcome);

struct StabilityCase {
  std::string property;
  double value{};
  Outcome outcome{};
  std::string words;
};

struct Stability {
  double penalty_limit_n_per_m{};  // of the simulated hand at the protocol's rate
  std::vector<StabilityCase> cases;
};

// The stimulus tapped by the simulated hand for two seconds a case, each time with one of its
// properties at the edge: stiffness, density, Poisson's ratio, thickness, damping, speed of the
// tap, sliding, penalty stiffness round the limit of the hand, no fixation.
Stability measure_stability(const protocols::Protocol& protocol,
                            const protocols::Stimulus& stimulus,
                            const core::ProgressHook& progress = {});
}  // namespace tapstudy::runner
