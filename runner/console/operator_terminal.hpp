#pragma once
#include <chrono>
#include <cstdint>
#include <thread>

#include "runner/console/console_api.hpp"
#include "runner/operators/operator_desk.hpp"
#include "runner/terminal/line_input.hpp"
#include "runner/terminal/stored_outcomes.hpp"
namespace tapstudy::runner {
// While the participant is at a page: what is typed at the terminal are the operator's commands,
// and two that ask and are not stored: status (once), and watch (a line every second, until the
// next line).
class OperatorTerminal {
 public:
  OperatorTerminal(LineInput& input, OperatorDesk& desk, const ConsoleApi& shown);

 private:
  void run(const std::stop_token& stop);
  void obey(const std::string& line);
  void order(const std::string& command);
  void show_if_watched();
  LineInput& input_;
  OperatorDesk& desk_;
  const ConsoleApi& shown_;
  bool is_watched_{false};
  std::chrono::steady_clock::time_point shown_at_;
  std::int64_t shown_steps_{-1};
  StoredOutcomes outcomes_{"", ""};
  std::jthread thread_;
};
}  // namespace tapstudy::runner
