#pragma once
#include <string>

#include "runner/line_input.hpp"
namespace tapstudy::runner {
// Who stands at the device and does what the program cannot.
class Operator {
 public:
  virtual ~Operator() = default;
  // Returns when it is done.
  virtual void please(const std::string& task) = 0;
  // What was measured, from above zero up to most.
  virtual double how_much(const std::string& task, double most) = 0;
};

// At the terminal: tasks go to stderr, what was measured comes from the input.
// Throws Stopped at the input's end or when the operator asks to stop.
class OperatorAtTerminal final : public Operator {
 public:
  explicit OperatorAtTerminal(LineInput& input) : input_{input} {}
  void please(const std::string& task) override;
  double how_much(const std::string& task, double most) override;

 private:
  std::string next_line();
  LineInput& input_;
};
}  // namespace tapstudy::runner
