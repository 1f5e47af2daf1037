#pragma once
#include "device/spidar/box_qp.hpp"
#include "device/spidar/kinematics.hpp"
namespace tapstudy::device {
// Force and torque about the grip centre.
struct Wrench {
  core::Vec3 force_n{core::Vec3::Zero()};
  core::Vec3 torque_nm{core::Vec3::Zero()};
};

struct TensionRange {
  double min_n{};  // below it a string goes slack
  double max_n{};
};

struct Tensions {
  PerString tension_n;
  Wrench achieved;
  double share{};       // achievable fraction of the wanted wrench, 0 to 1
  double residual_n{};  // |achieved - share × wanted|; torques scaled by the grip radius
  bool is_optimal{};    // the solver reached its optimum
};

// Tension distribution for a wrench: the minimum tensions that produce it if it is feasible, else
// the largest feasible wrench in its direction, because a wrong direction is worse than a reduced
// magnitude. One problem covers both: minimise |W (A't - s w)|² / 2 + eps |t|² / 2 - mu s over the
// tensions t in their range and the share s in 0..1, with W scaling torques by the grip radius, and
// eps and mu so small that they only resolve the remaining redundancy. Warm-started every tick.
class TensionSolver {
 public:
  explicit TensionSolver(const TensionRange& range) noexcept;
  Tensions solve(const Strings& strings, const Wrench& wanted) noexcept;

 private:
  TensionRange range_;
  BoxQpSolver<strings + 1> solver_;
  BoxQp<strings + 1>::Vector latest_;
};

// Wrench closure (force closure) margin: the maximum, over unit vectors t with A't = 0, of the
// smallest entry of t. Above zero the grip can be held still with all strings taut; its size
// measures the distance from losing wrench closure.
double closure_margin(const Strings& strings) noexcept;
}  // namespace tapstudy::device
