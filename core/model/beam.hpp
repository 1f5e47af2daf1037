#pragma once
#include <optional>
#include <string>

#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// A plate as an Euler-Bernoulli beam, held by one of its sides (a cantilever, as in Sreng, Lécuyer
// and Andriot 2008) or by two opposite ones. It bends along one direction only, without shear and
// rotatory inertia; Poisson's ratio has no effect.
struct Beam {
  int axis{};  // along which it reaches: 0 x, 1 y
  double length_m{};
  double thickness_m{};
  double held_at_m{};  // coordinate along the axis of a held end
  double towards{};    // +1 or -1: from there to the other end
  bool is_held_at_both_ends{};
};

// nullopt if the plate is none: not a box, held in another way, or less long than ten times its
// thickness, where shear is no longer small, or three times its width, where it bends as a plate.
std::optional<Beam> beam_of(const Plate& plate);
// The requirements of beam_of, as a noun phrase for error messages.
inline constexpr const char* beam_requirements =
    "a plate with a side, or two opposite ones of left, right, front and back, held along x, y and "
    "z by constraints, at least ten times as long from there as thick and three "
    "times as wide";

// Turned axes couple bending with torsion, which the closed form lacks.
inline constexpr const char* beams_are_isotropic =
    "a beam in closed form is isotropic (its material has youngs_moduli_pa; use fem)";

// The modes below the band limit in closed form: w_n = (b_n)^2 sqrt(E I / (rho A)), with cos b L
// cosh b L = -1 for one held end and +1 for two (Blevins 1979, table 8-1). Along z only.
// Throws ModelError if it is no beam, is orthotropic, or has more modes than anybody can feel.
BodyModes beam_modes(const BodySpec& body);
}  // namespace tapstudy::core
