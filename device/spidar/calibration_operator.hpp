#pragma once
#include <functional>
#include <string>
namespace tapstudy::device {
// The operator's manual steps at the device.
class CalibrationOperator {
 public:
  virtual ~CalibrationOperator() = default;
  // Asks for a task; returns when it is done.
  virtual void please(const std::string& task) = 0;
  // Asks for a measured value: above zero, at most max. keep_waiting is called many times a second;
  // where it throws, so does this.
  virtual double how_much(const std::string& task, double max,
                          const std::function<void()>& keep_waiting) = 0;
  // Something that the operator must know at once.
  virtual void warn(const std::string& /*what*/) noexcept {}
};
}  // namespace tapstudy::device
