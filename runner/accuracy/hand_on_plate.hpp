#pragma once
#include "core/tick/tap_renderer.hpp"
#include "device/hand/simulated_hand.hpp"
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
}  // namespace tapstudy::runner
