#pragma once
#include <string>

#include "device/spidar/calibration_operator.hpp"
#include "runner/terminal/line_input.hpp"
#include "runner/terminal/typed_commands.hpp"
namespace tapstudy::runner {
// The operator at the terminal: tasks go to stderr, measured values come from the input.
// Throws Stopped at end of input or when the operator asks to stop.
class OperatorAtTerminal final : public device::CalibrationOperator {
 public:
  explicit OperatorAtTerminal(LineInput& input) : input_{input} {}
  void please(const std::string& task) override;
  double how_much(const std::string& task, double max,
                  const std::function<void()>& keep_waiting) override;
  void warn(const std::string& what) noexcept override;

 private:
  std::string next_line(const std::function<void()>& keep_waiting);
  LineInput& input_;
  TypedCommands commands_;  // none: no session is running
};
}  // namespace tapstudy::runner
