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

// The stiffness of a contact, in two parts that act side by side between hand and surface.
struct ContactStiffness {
  double pad_n_per_m{};      // K, in series with the finger's spring
  double support_n_per_m{};  // S, beside both
};

// The split of a contact's stiffness K (the penalty stiffness of eq. 1) beside a finger of
// stiffness k, such that at rest the whole is as stiff as that of a technique without a finger:
//     S + K k / (K + k) = K,   S = K² / (K + k) > 0.
constexpr ContactStiffness contact_stiffness_beside(const Finger& finger,
                                                    double stiffness_n_per_m) noexcept {
  return {stiffness_n_per_m,
          stiffness_n_per_m * stiffness_n_per_m / (stiffness_n_per_m + finger.stiffness_n_per_m)};
}

// A finger that touches a vibrating surface, and the hand that carries it. Three bodies in a row,
// all positions along the surface's outward normal, from its rest position, outwards positive:
//
//   hand h        the device's haptic interaction point; its motion is given
//   finger y      mass m, held to the hand by the finger's spring k and damper b
//                     m y'' = c - f,     f = k (y - h) + b (y' - h')
//   surface u     of the vibrating body, u = sum of p_i q_i over its modes (paper eq. 9, 16)
//                     q_i'' + 2 zeta_i omega_i q_i' + omega_i² q_i = -p_i (c + s)
//   pad c         the finger pad's compression against the surface, by the stiffness K:
//                     c = K max(0, u - y - e)
//   support s     what of the contact's stiffness the finger does not make up, between hand and
//                 surface:
//                     s = S max(0, u - h - e)
//
// Both push and never pull; e is 0 but for the start of a contact (below). The force on the hand
// is f + s: what the device renders. m, k and b are the paper's finger (5.8 g, 300 N/m, 3 N s/m for
// a bare finger), K and S those of contact_stiffness_beside. At rest f = c, and so
//     f + s = K (u - h),   u = -C (f + s),   C = sum of p_i² / omega_i²:
// the hand presses on the penalty stiffness of eq. 1, as with every technique, and the surface
// carries all of the force that the hand feels.
//
// The paper instead gives the plate the finger's whole momentum at once, p = -m (n.v) n (eq. 14),
// lets it ring freely from then on, and renders k u + b u' (eq. 17). That is the limit of a contact
// so stiff and so lossy that the finger sticks, of a plate too heavy to feel it, and of a hand at
// rest. Here the impact takes time, the finger may bounce, and plate, finger and hand act on one
// another for as long as they touch.
//
// One tick. The hand moves at constant speed w, the forces c and s are held, and each oscillator's
// response to them is exact (HeldForceResponse; the finger in coordinates that move with the hand).
// Let the compressions g = u - y - e and p = u - h - e be g0 and p0 when the tick begins, and
//     g1 = G - (Cu + Cy) c - Cu s,   p1 = P - Cu c - Cu s
// when it ends, G and P being what they would be without contact, Cu and Cy the compliances of
// surface and finger. With V(g) = K max(0, g)² / 2 and W(p) = S max(0, p)² / 2 the energies, c and
// s are the one solution of
//
//     c (g1 - g0) = V(g1) - V(g0),   s (p1 - p0) = W(p1) - W(p0),
//
// the discrete gradients of V and W (Gonzalez 1996, Time integration and discrete Hamiltonian
// systems, J. Nonlinear Sci. 6). Both are convex and never fall, and the matrix of compliances is
// positive semidefinite, so that there is one solution, and c, s >= 0.
//
// Passivity, for any m, k, K > 0, S, b >= 0, modes and dt. By HeldForceResponse the surface's modes
// gain at most -(c + s) (u1 - u0), and the finger's energy (m y'² + k (y - h)²) / 2 at most
// c (y1 - y0) - F (h1 - h0), F the mean of f over the tick. V gains c (g1 - g0), W s (p1 - p0).
// Where e stands still all of that is at most -(F + s) (h1 - h0): the work of the hand against F +
// s. What is rendered is F + s + r + a (r and a below), and neither lessens that work. Hence modes,
// finger and contact gain no more than the hand's work against what it feels, and the scheme is
// stable at any rate.
//
// r: s is a mean over the tick, whereas a wall's penalty force is that of the hand's present place.
// The support is to feel as that wall does, so that to s is added what the hand's own motion has
// changed since the middle of the tick, r = S (h0 - h1) / 2, as far as S max(0, p1) and not beyond.
// It acts against the motion: r (h0 - h1) >= 0. Over a surface at rest s + r = S max(0, p1).
//
// The start of a contact. The finger comes as the hand does, its spring at rest, with the kinetic
// energy m w² / 2 that the hand gave it. The surface may swing above the hand just then: finger and
// hand would begin inside of it, with energy that nobody brought. So the contact yields without
// force by as much, e = max(0, u - h). Where neither pad nor support is compressed e falls to the
// larger of u - y and u - h, as far as 0, which changes no energy. And while the hand presses on,
// e falls by `yield_recovery` of its way: the hand pays for that, a = (c + s) (e0 - e1) / (h0 -
// h1). Thus at rest nothing is left of it.
//
// If the finger also moves along the surface, g0 and p0 are taken at the new place: the contact's
// energy then changes by the work of pushing it along the deformed surface.
class CoupledFinger {
 public:
  // mass, stiffness > 0; damping >= 0; contact stiffnesses >= 0.
  CoupledFinger(const Finger& finger, const ContactStiffness& contact, double dt_s) noexcept;

  // One tick before the first in contact: the finger moves as the hand does.
  void begin(double hand_m, double hand_velocity_m_s, double surface_m) noexcept;
  // One tick, at the end of which the hand is here. Returns c + s [N].
  double tick(double hand_m, const SurfaceTick& surface) noexcept;
  // Where the hand is when the last tick ends.
  double hand_m() const noexcept { return hand_m_; }
  // F + s + r + a: on the hand, of the last tick [N, outwards positive].
  double force_on_hand_n() const noexcept { return force_on_hand_n_; }
  // The energy of finger, finger's spring, pad and support.
  double energy_j(double surface_m) const noexcept;

 private:
  // What the hand feels of the contact beside the finger's spring: s + r + a.
  double felt_beside_finger_n(double hand_from_m, double pad_n, double support_n,
                              double yield_before_m, double support_after_m) const noexcept;

  Finger finger_;
  ContactStiffness contact_;
  double dt_s_;
  StateTransition step_;
  HeldForceResponse per_newton_;
  double hand_m_{0.0};
  double offset_m_{0.0};      // y - h
  double velocity_m_s_{0.0};  // y'
  double yield_m_{0.0};       // e
  double force_on_hand_n_{0.0};
};

// One of two contacts with one surface, during a tick: g0, G and K above.
struct ContactTick {
  double before_m{};
  double unloaded_m{};
  double stiffness_n_per_m{};  // >= 0
};

// c of the equation above for a contact alone; compliance >= 0. If 1 / stiffness is far less than
// the compliance, the compression changes sign from tick to tick, but the energy is kept.
double held_contact_force_n(const ContactTick& contact, double compliance_m_per_n) noexcept;

struct HeldContacts {
  double pad_n{};
  double support_n{};
};
// c and s of the equations above, in closed form where both stay in contact; compliances >= 0.
HeldContacts held_contacts(const ContactTick& pad, const ContactTick& support,
                           double surface_compliance_m_per_n,
                           double finger_compliance_m_per_n) noexcept;
}  // namespace tapstudy::core
