#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/model/progress.hpp"
#include "core/tick/tap_renderer.hpp"
#include "device/hand/simulated_hand.hpp"
#include "protocols/protocol.hpp"
namespace tapstudy::runner {
struct TestTap {
  core::Vec3 at_m{core::Vec3::Zero()};  // of the surface under the finger, in the plate frame
  double speed_m_s{0.3};                // 0: the finger is placed gently
  double sliding_m{0.0};                // how far the aim moves along x while the finger stays
  double press_m{0.004};
};

// Behaviour of the closed loop of hand and plate over two seconds.
struct LoopBehaviour {
  bool is_finite{true};
  int impacts{0};
  double max_energy_j{0.0};  // of the plate
  double max_gain_j{0.0};    // by the plate, in a tick without an impact
  double max_force_n{0.0};
  double residual_oscillation{0.0};  // of the force, last tenth of a second over the whole
};

// The hand taps once and stays. Without force limits or safety stage, to expose instability.
LoopBehaviour tap_and_stay(core::TapRenderer& renderer, const core::HandBody& body, double dt_s,
                           const TestTap& tap);

// The outcome of a tap at an extreme parameter value.
enum class Outcome {
  dies_out,  // a second after the tap the force oscillation has practically decayed
  persists,  // sustained but bounded oscillation: no damping, or contact chatter
  refused,   // the model was rejected; the error states why
  untested,  // the plate has no mode in the band: nothing of it swings
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
