#pragma once
#include <optional>

namespace tapstudy::runner {
// While it lives, Ctrl-S and Ctrl-Q at the terminal do nothing: output stopped by Ctrl-S would hold
// up the thread that supervises a trial, and so end it. Has no effect on a file or pipe.
class NoFlowControl {
 public:
  explicit NoFlowControl(int descriptor);
  ~NoFlowControl();
  NoFlowControl(const NoFlowControl&) = delete;
  NoFlowControl& operator=(const NoFlowControl&) = delete;
  NoFlowControl(NoFlowControl&&) = delete;
  NoFlowControl& operator=(NoFlowControl&&) = delete;

 private:
  int descriptor_;
  std::optional<unsigned> input_modes_;  // as they were
};
}  // namespace tapstudy::runner
