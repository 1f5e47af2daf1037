#pragma once
#include <string>
namespace tapstudy::device {
// Who stands at the device and does what the program cannot.
class CalibrationOperator {
 public:
  virtual ~CalibrationOperator() = default;
  // Returns when the task is done.
  virtual void please(const std::string& task) = 0;
  // What was measured: above zero, at most max.
  virtual double how_much(const std::string& task, double max) = 0;
};
}  // namespace tapstudy::device
