#pragma once
#include "device/hand/simulated_hand.hpp"
namespace tapstudy::device {
// The largest stable penalty stiffness for a hand at rest against a wall. A force f = -K x, sampled
// once per tick, held, and exerted so many ticks later, lags behind the hand and generates energy;
// above this K [N/m] it is more than the muscle dissipates, and the contact chatters. From the
// closed loop's matrix over one tick, the hand's state transition with its response to a held force
// and the positions not yet answered as further states: all eigenvalues inside the unit circle. For
// short ticks and no delay it tends to 2 b / dt (compare Colgate & Schenkel 1997: passive up to
// that value, with b the total physical damping; with a delay t_d, b > K (dt / 2 + t_d)).
double largest_stable_penalty_n_per_m(const core::HandBody& hand, double dt_s, int delay_ticks = 0);
}  // namespace tapstudy::device
