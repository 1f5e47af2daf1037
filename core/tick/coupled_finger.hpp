#pragma once
#include "core/settings/render_settings.hpp"
#include "core/tick/state_transition.hpp"
namespace tapstudy::core {
// The surface under the finger during one tick, along the outward normal, outwards positive.
struct SurfaceTick {
  double before_m{};            // displacement when the tick begins
  double unloaded_m{};          // and when it ends, if the finger did not press
  double compliance_m_per_n{};  // how much lower it ends for each newton of a force held on it
};

// A finger that touches a vibrating surface, and the hand that carries it. Three bodies in a row,
// all positions along the surface's outward normal, from its rest position, outwards positive:
//
//   hand h        the device's haptic interaction point; its motion is given
//   finger y      mass m, held to the hand by the finger's spring k and damper b
//                     m y'' = c - f,     f = k (y - h) + b (y' - h')
//   surface u     of the vibrating body, u = sum of p_i q_i over its modes (paper eq. 9, 16)
//                     q_i'' + 2 zeta_i omega_i q_i' + omega_i² q_i = -p_i c
//   contact c     the finger pad's compression against the surface, by the contact stiffness K:
//                     c = K max(0, u - y - e) >= 0: it pushes and never pulls; e is 0 but for the
//                     start of a contact (below)
//
// f is the force of the finger on the hand: what the device renders. m, k and b are the paper's
// finger (5.8 g, 300 N/m, 3 N s/m for a bare finger), K the penalty stiffness of eq. 1.
//
// The paper instead gives the plate the finger's whole momentum at once, p = -m (n.v) n (eq. 14),
// lets it ring freely from then on, and renders k u + b u' (eq. 17). That is the limit of a contact
// so stiff and so lossy that the finger sticks, of a plate too heavy to feel it, and of a hand at
// rest. Here the impact takes time, the finger may bounce, and plate, finger and hand act on one
// another for as long as they touch.
//
// One tick. The hand moves at constant speed w, the contact force c is held, and each oscillator's
// response to that is exact (HeldForceResponse; the finger in coordinates that move with the
// hand). Let the compression g = u - y - e be g0 when the tick begins, and G - C c when it ends, G
// being what it would be without contact and C the compliances of surface and finger together. With
// V(g) = K max(0, g)² / 2 the contact's energy, c is the one root of the scalar equation
//
//     c (g1 - g0) = V(g1) - V(g0),   g1 = G - C c,
//
// the discrete gradient of V (Gonzalez 1996, Time integration and discrete Hamiltonian systems,
// J. Nonlinear Sci. 6), solved in closed form. V is convex and never falls with g, so the root is
// unique and c >= 0.
//
// Passivity, for any m, k, K > 0, b >= 0, modes and dt. By HeldForceResponse the surface's modes
// gain at most -c (u1 - u0), and the finger's energy (m y'² + k (y - h)²) / 2 at most
// c (y1 - y0) - F (h1 - h0), F the mean of f over the tick. Together that is -c (g1 - g0) - F (h1 -
// h0); and V gains c (g1 - g0). So modes + finger + contact gain at most -F (h1 - h0): the work of
// the hand against the force rendered to it, which is F itself. Hence the scheme is stable at any
// rate.
//
// The start of a contact. The finger comes as the hand does, its spring at rest, with the kinetic
// energy m w² / 2 that the hand gave it. The surface may swing above the hand just then: the finger
// would begin inside of it, with energy that nobody brought. So the pad yields without force by as
// much, e = max(0, u - y), and e falls with u - y, as far as 0, and never rises. It changes only
// where V = 0, so that the law above holds from the first tick on.
//
// If the finger also moves along the surface, g0 is taken at the new place: the contact's
// energy then changes by the work of pushing it along the deformed surface.
class CoupledFinger {
 public:
  // mass, stiffness > 0; damping >= 0; contact stiffness >= 0.
  CoupledFinger(const Finger& finger, double contact_stiffness_n_per_m, double dt_s) noexcept;

  // One tick before the first in contact: the finger moves as the hand does.
  void begin(double hand_m, double hand_velocity_m_s, double surface_m) noexcept;
  // One tick, at the end of which the hand is here. Returns c [N].
  double tick(double hand_m, const SurfaceTick& surface) noexcept;
  // Where the hand is when the last tick ends.
  double hand_m() const noexcept { return hand_m_; }
  // F: the mean force of the finger on the hand in the last tick [N, outwards positive].
  double force_on_hand_n() const noexcept { return force_on_hand_n_; }
  // The energy of finger, finger's spring and contact.
  double energy_j(double surface_m) const noexcept;

 private:
  Finger finger_;
  double contact_stiffness_n_per_m_;
  double dt_s_;
  StateTransition step_;
  HeldForceResponse per_newton_;
  double hand_m_{0.0};
  double offset_m_{0.0};      // y - h
  double velocity_m_s_{0.0};  // y'
  double yield_m_{0.0};       // e
  double force_on_hand_n_{0.0};
};

// c of the equation above. compliance > 0, stiffness >= 0. If 1 / stiffness is far less than the
// compliance, the compression changes sign from tick to tick, but the energy is kept.
double held_contact_force_n(double compression_before_m, double unloaded_compression_m,
                            double compliance_m_per_n, double stiffness_n_per_m) noexcept;
}  // namespace tapstudy::core
