#pragma once
#include "device/spidar/box_qp.hpp"
#include "device/spidar/pose.hpp"
namespace tapstudy::device {
// Force and torque about the grip's middle.
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
  double share{};       // of the wanted wrench that the strings can make, 0 to 1
  double residual_n{};  // what achieved lacks of share × wanted; torques count by the grip's radius
};

// Tensions for a wrench: exactly it with the least tensions where that can be, else as much of it
// as there is along its own direction, for a force that turns is worse than one that is too small.
// One problem serves both: minimise |W (A't - s w)|² / 2 + eps |t|² / 2 - mu s over the tensions t
// in their range and the share s in 0..1, with W weighing torques by the grip's radius, and eps and
// mu so small that they decide only what the wrench leaves open. Warm from tick to tick.
class TensionSolver {
 public:
  explicit TensionSolver(const TensionRange& range) noexcept;
  Tensions solve(const Strings& strings, const Wrench& wanted) noexcept;

 private:
  TensionRange range_;
  BoxQpSolver<strings + 1> solver_;
  BoxQp<strings + 1>::Vector latest_;
};

// The smallest share of a string in the most even way to pull without any effect: the largest
// smallest entry of a unit vector t with A't = 0. Above zero the grip can be held still with all
// strings taut (wrench closure); from there on it tells how far from losing that it is.
double closure_margin(const Strings& strings) noexcept;
}  // namespace tapstudy::device
