#pragma once
#include <string>
namespace tapstudy::device {
// The operator's manual steps at the device.
class CalibrationOperator {
 public:
  virtual ~CalibrationOperator() = default;
  // Asks for a task; returns when it is done.
  virtual void please(const std::string& task) = 0;
  // Asks for a measured value: above zero, at most max.
  virtual double how_much(const std::string& task, double max) = 0;
};
}  // namespace tapstudy::device
