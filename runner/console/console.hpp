#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "results/rows.hpp"
#include "runner/console/browser_participant.hpp"
#include "runner/console/console_api.hpp"
#include "runner/console/console_server.hpp"
#include "runner/session/operators/operator_desk.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/typed_input.hpp"
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

struct ConsoleRequest {
  ServerAddress address;
  std::string language{"en"};
};

// The pages of one session, their server, and the participant who sits before one of them.
class Console {
 public:
  struct Session {
    const protocols::Protocol& protocol;
    const core::Placement& placement;  // of the loop
    const results::SessionRow& row;
    OperatorDesk& desk;
    std::function<void()> move_hand;  // as a TerminalParticipant's
    std::function<std::optional<MaskingInView>()> masking;
  };
  // Throws InvalidInput if the address cannot be listened to.
  Console(const ConsoleRequest& request, const Session& session);
  // Tells open pages that the session has ended.
  ~Console();
  Console(const Console& other) = delete;
  Console& operator=(const Console& other) = delete;
  Console(Console&& other) = delete;
  Console& operator=(Console&& other) = delete;

  Participant& participant() { return participant_; }
  void watch(const core::TraceSample& sample) { live_.add(sample); }
  void note_state(const results::SessionEventRow& event);
  const ConsoleApi& api() const { return api_; }
  std::string url(Role role) const { return server_.url(role); }

 private:
  ConsoleApi::Session in_view(const Session& session);
  BrowserParticipant::Context context(const Session& session);

  std::mutex mutex_;
  std::string state_{"begun"};
  std::string last_fault_;
  bool shows_plate_;
  LiveView live_;
  Scenes scenes_;
  ScreenExchange screens_;
  BrowserParticipant participant_;
  ConsoleApi api_;
  ConsoleServer server_;
};
}  // namespace tapstudy::runner
