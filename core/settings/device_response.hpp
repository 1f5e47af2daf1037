#pragma once
#include <vector>
namespace tapstudy::core {
// How much of a commanded vibration a device renders, as measured: force at the grip over force
// commanded, in magnitude.
struct DeviceResponse {
  struct Point {
    double frequency_hz{};  // ascending, > 0
    double gain{};          // > 0; 1: as commanded
  };
  std::vector<Point> points;  // at least one; straight lines between them on logarithmic axes
  double max_boost{4.0};      // no frequency is amplified by more
};
}  // namespace tapstudy::core
