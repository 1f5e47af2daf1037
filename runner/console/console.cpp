#include "runner/console/console.hpp"

#include <chrono>
#include <thread>

#include "runner/terminal/say.hpp"

namespace tapstudy::runner {
Console::Console(const ConsoleRequest& request, const Session& session)
    : shows_plate_{session.protocol.display.shows_plate},
      scenes_{session.protocol, session.placement},
      screens_{request.language, session.protocol.title},
      participant_{screens_, context(session)},
      api_{in_view(session), screens_, session.desk, live_, scenes_},
      server_{request.address, api_} {}

Console::~Console() {
  constexpr std::chrono::milliseconds time_to_arrive{300};
  screens_.show({.kind = ScreenKind::ended});
  if (screens_.open_pages() > 0) {
    std::this_thread::sleep_for(time_to_arrive);
  }
}

BrowserParticipant::Context Console::context(const Session& session) {
  OperatorDesk& desk = session.desk;
  return {session.move_hand,
          [this, &desk, &protocol = session.protocol](std::size_t alternative) {
            const auto view = desk.view().trial;
            const bool is_rendered =
                view && view->prompt.block->presented == protocols::Presented::virtual_plates;
            return is_rendered && shows_plate_
                       ? scenes_.number_of(view->trial.alternatives.at(alternative).stimulus,
                                           protocol.block(view->trial.block))
                       : std::nullopt;
          },
          [&desk](const std::string& cause) {
            return desk.waits_for_operator(cause, [&] {
              say("\n{}\n  The trial is not stored yet, but kept. To try again, type resume.\n",
                  cause);
            });
          },
          [&desk](const std::string& why) {
            desk.pause(why);
            say("\npaused: {}. To go on, type resume.\n", why);
          }};
}

ConsoleApi::Session Console::in_view(const Session& session) {
  const auto guarded = [this](const std::string& text) {
    return [this, &text] {
      const std::lock_guard lock{mutex_};
      return text;
    };
  };
  return {session.protocol.title,
          session.row.participant_id,
          results::to_text(session.row.mode),
          session.row.device,
          session.protocol.display.is_operator_blind,
          guarded(state_),
          guarded(last_fault_),
          session.masking};
}

void Console::note_state(const results::SessionEventRow& event) {
  if (event.state == "exploring") {
    live_.begin_trial();
  }
  const std::lock_guard lock{mutex_};
  state_ = event.state;
  last_fault_ = event.state == "faulted" ? event.detail : "";
}
}  // namespace tapstudy::runner
