#include "core/tick/coupled_finger.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
namespace tapstudy::core {
namespace {
double frequency_rad_s(const Finger& finger) noexcept {
  return std::sqrt(finger.stiffness_n_per_m / finger.mass_kg);
}
double damping_ratio(const Finger& finger) noexcept {
  return finger.damping_n_s_per_m / (2.0 * finger.mass_kg * frequency_rad_s(finger));
}

// The positive root of a c² + b c = d, without cancellation; a > 0, d >= 0.
double positive_root(double a, double b, double d) noexcept {
  const double root = std::sqrt(b * b + 4.0 * a * d);
  if (b <= 0.0) {
    return (root - b) / (2.0 * a);
  }
  return 2.0 * d / (b + root);
}

double stored_j(double compression_m, double stiffness_n_per_m) noexcept {
  const double compressed_m = std::max(0.0, compression_m);
  return 0.5 * stiffness_n_per_m * compressed_m * compressed_m;
}

// Of the hand's way inwards: how much of the yield is gone with it.
constexpr double yield_recovery = 0.25;
}  // namespace

CoupledFinger::CoupledFinger(const Finger& finger, const ContactStiffness& contact,
                             double dt_s) noexcept
    : finger_{finger},
      contact_{contact},
      dt_s_{dt_s},
      step_{exact_transition(frequency_rad_s(finger), damping_ratio(finger), dt_s)},
      per_newton_{held_force_response(Integrator::exact, frequency_rad_s(finger),
                                      damping_ratio(finger), dt_s)} {
  per_newton_.q /= finger.mass_kg;
  per_newton_.v /= finger.mass_kg;
}

void CoupledFinger::begin(double hand_m, double hand_velocity_m_s, double surface_m) noexcept {
  hand_m_ = hand_m;
  offset_m_ = 0.0;
  yield_m_ = std::max(0.0, surface_m - hand_m);
  velocity_m_s_ = hand_velocity_m_s;
}

double CoupledFinger::tick(double hand_m, const SurfaceTick& surface) noexcept {
  const double hand_from_m = hand_m_;
  const double yield_before_m = yield_m_;
  const double clear_m = surface.before_m - hand_from_m - yield_before_m;
  const double pressed_m = std::max(0.0, hand_from_m - hand_m);
  yield_m_ = std::max(0.0, yield_before_m - yield_recovery * pressed_m);

  const double hand_velocity_m_s = (hand_m - hand_from_m) / dt_s_;
  const double relative_m_s = velocity_m_s_ - hand_velocity_m_s;
  const double unloaded_m = step_.qq * offset_m_ + step_.qv * relative_m_s;
  const double unloaded_clear_m = surface.unloaded_m - hand_m - yield_m_;
  const auto [pad_n, support_n] =
      held_contacts({clear_m - offset_m_, unloaded_clear_m - unloaded_m, contact_.pad_n_per_m},
                    {clear_m, unloaded_clear_m, contact_.support_n_per_m},
                    surface.compliance_m_per_n, per_newton_.q);

  const double velocity_m_s =
      hand_velocity_m_s + step_.vq * offset_m_ + step_.vv * relative_m_s + per_newton_.v * pad_n;
  const double spring_n = pad_n - finger_.mass_kg * (velocity_m_s - velocity_m_s_) / dt_s_;
  offset_m_ = unloaded_m + per_newton_.q * pad_n;
  velocity_m_s_ = velocity_m_s;
  hand_m_ = hand_m;
  const double clear_after_m =
      surface.unloaded_m - surface.compliance_m_per_n * (pad_n + support_n) - hand_m;
  force_on_hand_n_ = spring_n + felt_beside_finger_n(hand_from_m, pad_n, support_n, yield_before_m,
                                                     clear_after_m - yield_m_);
  yield_m_ = std::clamp(std::max(clear_after_m, clear_after_m - offset_m_), 0.0, yield_m_);
  return pad_n + support_n;
}

double CoupledFinger::felt_beside_finger_n(double hand_from_m, double pad_n, double support_n,
                                           double yield_before_m,
                                           double support_after_m) const noexcept {
  const double pressed_m = hand_from_m - hand_m_;
  const double to_end_n = contact_.support_n_per_m * std::max(0.0, support_after_m) - support_n;
  const double of_motion_n = std::clamp(0.5 * contact_.support_n_per_m * pressed_m,
                                        std::min(0.0, to_end_n), std::max(0.0, to_end_n));
  const double recovered_m = yield_before_m - yield_m_;
  const double of_recovery_n =
      recovered_m > 0.0 ? (pad_n + support_n) * recovered_m / pressed_m : 0.0;
  return support_n + of_motion_n + of_recovery_n;
}

double CoupledFinger::energy_j(double surface_m) const noexcept {
  const double clear_m = surface_m - hand_m_ - yield_m_;
  return 0.5 * (finger_.mass_kg * velocity_m_s_ * velocity_m_s_ +
                finger_.stiffness_n_per_m * offset_m_ * offset_m_) +
         stored_j(clear_m - offset_m_, contact_.pad_n_per_m) +
         stored_j(clear_m, contact_.support_n_per_m);
}

double held_contact_force_n(const ContactTick& contact, double compliance_m_per_n) noexcept {
  const auto [before, unloaded, stiffness_n_per_m] = contact;
  if (before <= 0.0 && unloaded <= 0.0) {
    return 0.0;
  }
  const double half = 0.5 * stiffness_n_per_m;
  if (before < 0.0) {  // contact begins: c (g1 - g0) = K g1² / 2, the root with g1 > 0
    const double gain = stiffness_n_per_m * unloaded * compliance_m_per_n;
    const double apart = unloaded - before;
    const double root = std::sqrt(apart * apart - 2.0 * gain * before);
    return stiffness_n_per_m * unloaded * unloaded / (apart + gain + root);
  }
  const double held = half * (before + unloaded) / (1.0 + half * compliance_m_per_n);
  if (unloaded >= compliance_m_per_n * held) {
    return held;
  }
  // contact ends: c (g0 - g1) = K g0² / 2
  return positive_root(compliance_m_per_n, before - unloaded, half * before * before);
}

namespace {
// (V(g1) - V(g0)) / (g1 - g0) of V(g) = K max(0, g)² / 2.
double discrete_gradient_n(double before_m, double after_m, double stiffness_n_per_m) noexcept {
  const double low = std::min(before_m, after_m);
  const double high = std::max(before_m, after_m);
  if (high <= 0.0) {
    return 0.0;
  }
  return low >= 0.0 ? 0.5 * stiffness_n_per_m * (low + high)
                    : 0.5 * stiffness_n_per_m * high * (high / (high - low));
}

// Both contacts with one unknown, s: the pad's force follows from it in closed form.
class TwoContacts {
 public:
  TwoContacts(const ContactTick& pad, const ContactTick& support, double surface_m_per_n,
              double finger_m_per_n) noexcept
      : pad_{pad},
        support_{support},
        surface_m_per_n_{surface_m_per_n},
        finger_m_per_n_{finger_m_per_n} {}

  // Both in contact when the tick begins and when it ends: two linear equations.
  std::optional<HeldContacts> held_throughout() const noexcept {
    const double pad = 0.5 * pad_.stiffness_n_per_m;
    const double support = 0.5 * support_.stiffness_n_per_m;
    const double of_pad = 1.0 + pad * (surface_m_per_n_ + finger_m_per_n_);
    const double of_support = 1.0 + support * surface_m_per_n_;
    const double pad_side_n = pad * (pad_.before_m + pad_.unloaded_m);
    const double support_side_n = support * (support_.before_m + support_.unloaded_m);
    const double coupling = pad * support * surface_m_per_n_ * surface_m_per_n_;
    const double determinant = of_pad * of_support - coupling;
    const HeldContacts held{
        (of_support * pad_side_n - pad * surface_m_per_n_ * support_side_n) / determinant,
        (of_pad * support_side_n - support * surface_m_per_n_ * pad_side_n) / determinant};
    const double sunk_m = surface_m_per_n_ * (held.pad_n + held.support_n);
    const bool is_held = pad_.before_m >= 0.0 && support_.before_m >= 0.0 &&
                         pad_.unloaded_m - finger_m_per_n_ * held.pad_n >= sunk_m &&
                         support_.unloaded_m >= sunk_m;
    return is_held ? std::optional{held} : std::nullopt;
  }

  // The root of s - (discrete gradient of the support's energy), which rises with s from a value
  // <= 0: false position in Illinois's form (Dowell & Jarratt 1971), with a bisection now and then,
  // so that the number of steps is bounded.
  HeldContacts searched() const noexcept {
    const double most_n =
        discrete_gradient_n(support_.before_m, support_.unloaded_m, support_.stiffness_n_per_m);
    Bracket bracket{0.0, most_n, excess_n(0.0), excess_n(most_n)};
    double root_n = bracket.at_low_n >= 0.0 ? 0.0 : most_n;
    for (int step = 1; step <= max_steps && bracket.holds_a_root(); ++step) {
      const bool is_bisection = step % 4 == 0;
      root_n = bracket.next_n(is_bisection);
      const double at_root_n = excess_n(root_n);
      if (std::abs(at_root_n) <= precision * root_n || bracket.is_narrow()) {
        break;
      }
      bracket.narrow(root_n, at_root_n, is_bisection);
    }
    return {pad_n(root_n), root_n};
  }

 private:
  static constexpr int max_steps = 200;
  static constexpr double precision = 1e-14;

  struct Bracket {
    double low_n;
    double high_n;
    double at_low_n;
    double at_high_n;

    bool holds_a_root() const noexcept { return at_low_n < 0.0 && at_high_n > 0.0; }
    bool is_narrow() const noexcept { return high_n - low_n <= precision * high_n; }
    double next_n(bool is_bisection) const noexcept {
      return is_bisection ? 0.5 * (low_n + high_n)
                          : (low_n * at_high_n - high_n * at_low_n) / (at_high_n - at_low_n);
    }
    // The value at the end that stays is halved, so that it does not stay for ever.
    void narrow(double root_n, double at_root_n, bool is_bisection) noexcept {
      const double kept = is_bisection ? 1.0 : 0.5;
      if (at_root_n < 0.0) {
        low_n = root_n;
        at_low_n = at_root_n;
        at_high_n *= kept;
      } else {
        high_n = root_n;
        at_high_n = at_root_n;
        at_low_n *= kept;
      }
    }
  };

  double pad_n(double support_n) const noexcept {
    return held_contact_force_n(
        {pad_.before_m, pad_.unloaded_m - surface_m_per_n_ * support_n, pad_.stiffness_n_per_m},
        surface_m_per_n_ + finger_m_per_n_);
  }
  double excess_n(double support_n) const noexcept {
    const double after_m = support_.unloaded_m - surface_m_per_n_ * (pad_n(support_n) + support_n);
    return support_n - discrete_gradient_n(support_.before_m, after_m, support_.stiffness_n_per_m);
  }

  ContactTick pad_;
  ContactTick support_;
  double surface_m_per_n_;
  double finger_m_per_n_;
};
}  // namespace

HeldContacts held_contacts(const ContactTick& pad, const ContactTick& support,
                           double surface_compliance_m_per_n,
                           double finger_compliance_m_per_n) noexcept {
  const TwoContacts contacts{pad, support, surface_compliance_m_per_n, finger_compliance_m_per_n};
  if (const auto held = contacts.held_throughout()) {
    return *held;
  }
  return contacts.searched();
}
}  // namespace tapstudy::core
