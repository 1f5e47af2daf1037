#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/progress_hook.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
// The outcome of a tap at an extreme parameter value.
enum class Outcome {
  dies_out,  // a second after the tap the force oscillation has practically decayed
  persists,  // sustained but bounded oscillation: no damping, or contact chatter
  refused,   // the model was rejected; the error states why
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

// The simulated hand taps the stimulus for two seconds per case, each with one parameter at an
// extreme value: stiffness, density, Poisson's ratio, thickness, damping, tapping speed, sliding,
// penalty stiffness around the hand's stability limit, no fixation.
Stability measure_stability(const protocols::Protocol& protocol,
                            const protocols::Stimulus& stimulus,
                            const core::ProgressHook& progress = {});
}  // namespace tapstudy::runner
