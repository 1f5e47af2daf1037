#pragma once
#include <thread>

#include "runner/operators/operator_desk.hpp"
#include "runner/terminal/line_input.hpp"
namespace tapstudy::runner {
// While the participant is at a page: what is typed at the terminal are the operator's commands.
class OperatorTerminal {
 public:
  OperatorTerminal(LineInput& input, OperatorDesk& desk);

 private:
  void run(const std::stop_token& stop);
  void obey(const std::string& line);
  LineInput& input_;
  OperatorDesk& desk_;
  std::jthread thread_;
};
}  // namespace tapstudy::runner
