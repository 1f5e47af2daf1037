#pragma once
#include <Eigen/Core>
#include <vector>
namespace tapstudy::core {
// The force on a finger after an impact, as it was measured: along the outward normal, from the
// impact on.
struct RecordedTap {
  Eigen::Vector2d at_m{Eigen::Vector2d::Zero()};  // plate frame
  double speed_m_s{};                             // of the impact; > 0
  std::vector<double> force_n;
};

struct RecordedTaps {
  double rate_hz{};  // of the samples; > 0
  std::vector<RecordedTap> taps;
};
}  // namespace tapstudy::core
