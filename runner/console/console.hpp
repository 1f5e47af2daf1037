#pragma once
#include <functional>
#include <mutex>
#include <string>

#include "results/rows.hpp"
#include "runner/console/browser_participant.hpp"
#include "runner/console/console_api.hpp"
#include "runner/console/console_server.hpp"
namespace tapstudy::runner {
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
