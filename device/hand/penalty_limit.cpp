#include "device/hand/penalty_limit.hpp"

#include <algorithm>
#include <limits>
namespace tapstudy::device {
double largest_stable_penalty_n_per_m(const core::HandBody& hand, double dt_s) {
  const double muscle = hand.muscle_stiffness_n_per_m;
  const auto [qq, qv, vq, vv] = muscle_transition(hand, dt_s);
  const double trace = qq + vv;
  const double determinant = qq * vv - qv * vq;
  // both are linear in K
  const double trace_falls = (1.0 - qq) / muscle;
  const double determinant_rises = -((1.0 - qq) * vv + qv * vq) / muscle;
  double limit = std::numeric_limits<double>::infinity();
  if (determinant_rises > 0.0) {  // determinant < 1
    limit = (1.0 - determinant) / determinant_rises;
  }
  if (trace_falls > determinant_rises) {  // 1 + trace + determinant > 0
    limit = std::min(limit, (1.0 + trace + determinant) / (trace_falls - determinant_rises));
  }
  return limit;
}
}  // namespace tapstudy::device
