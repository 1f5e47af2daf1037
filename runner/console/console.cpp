#include "runner/console/console.hpp"

#include <chrono>
#include <thread>

#include "core/error.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
OperatorTerminal::OperatorTerminal(LineInput& input, OperatorDesk& desk, const ConsoleApi& shown)
    : input_{input}, desk_{desk}, shown_{shown}, thread_{[this](const std::stop_token& stop) {
        run(stop);
        outcomes_.finish();
      }} {}

// At the end of input the session goes on: a page may have an operator, too.
void OperatorTerminal::run(const std::stop_token& stop) {
  while (const auto line = input_.next([&] {
    outcomes_.say_known();
    show_if_watched();
    return !stop.stop_requested() && !stop_was_asked();
  })) {
    if (asks_to_quit(*line)) {
      ask_to_stop();
      return;
    }
    is_watched_ = false;
    if (!line->empty()) {
      obey(*line);
    }
  }
}

void OperatorTerminal::show_if_watched() {
  constexpr std::chrono::seconds interval{1};
  const auto now = std::chrono::steady_clock::now();
  if (is_watched_ && now - shown_at_ >= interval) {
    shown_at_ = now;
    write_to_terminal(shown_.live(shown_steps_));
  }
}

void OperatorTerminal::obey(const std::string& line) {
  const bool is_watch = line == "watch";
  if (is_watch || line == "status") {
    write_to_terminal(shown_.status());
    is_watched_ = is_watch;
  } else {
    order(line);
  }
}

void OperatorTerminal::order(const std::string& command) {
  try {
    outcomes_.add(desk_.post(parse_operator_command(command)));
    outcomes_.say_known();
  } catch (const core::InvalidInput& error) {
    say("{}; status and watch show what the session does\n", error.what());
  } catch (const std::exception& error) {  // none may leave a thread
    say("not stored: {}\n", error.what());
  }
}

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
