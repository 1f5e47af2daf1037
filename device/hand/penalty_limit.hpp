#pragma once
#include "device/hand/simulated_hand.hpp"
namespace tapstudy::device {
// The largest stable penalty stiffness for a hand at rest against a wall. A force f = -K x, sampled
// once per tick with zero-order hold, lags behind the hand and generates energy; above this K [N/m]
// it is more than the muscle dissipates, and the contact chatters. From the closed loop's matrix
// over one tick, A = Phi - K Gamma [1 0] with the hand's state transition Phi and its response
// Gamma to a held force: Jury's conditions for both eigenvalues inside the unit circle. For short
// ticks it tends to 2 b / dt (compare Colgate & Schenkel 1997: passive up to that value, with b the
// total physical damping).
double largest_stable_penalty_n_per_m(const core::HandBody& hand, double dt_s);
}  // namespace tapstudy::device
