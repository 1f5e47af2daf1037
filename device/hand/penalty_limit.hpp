#pragma once
#include "device/hand/simulated_hand.hpp"
namespace tapstudy::device {
// The stiffest wall that a hand can rest against. A force f = -K x, computed once a tick and held
// until the next, lags behind the hand and feeds it energy; beyond this K [N/m] more than its
// muscle takes out, and it chatters. From the closed loop's matrix over one tick, A = Phi - K Gamma
// [1 0] with the hand's exact motion Phi and its answer Gamma to a held force: Jury's conditions
// for both eigenvalues within the unit circle. For short ticks it tends to 2 b / dt (compare
// Colgate & Schenkel 1997: passive up to that with b the whole physical damping).
double largest_stable_penalty_n_per_m(const core::HandBody& hand, double dt_s);
}  // namespace tapstudy::device
