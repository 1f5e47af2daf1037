#include "runner/live_session/live_trials.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "runner/console/console.hpp"
#include "runner/session/devices/actuator_card.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/devices/masking_card.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
void introduce(const Console& console) {
  say("participant's page: {}\noperator's page:    {}\n", console.url(Role::participant),
      console.url(Role::operator_of_session));
  std::vector<std::string_view> names;
  std::ranges::transform(operator_actions(), std::back_inserter(names), &ActionInfo::name);
  say("here: {}, status, watch, quit\n", fmt::join(names, ", "));
}

TypedCommands commands_to(OperatorDesk& desk) {
  return TypedCommands{
      [&desk](const std::string& command) { return desk.post(parse_operator_command(command)); }};
}

// The participant may still be at the screen, and must not read which plate comes; nor may the
// participant's Enter, pressed twice, say that it was mounted.
bool is_mounted(const LiveTrials::Parts& parts, const std::string& task) {
  const bool is_operator_there =
      asked_and_done(parts.input, parts.commands, "\nPlease call the operator. Operator:", "ready");
  clear_screen();
  const bool is_done =
      is_operator_there && asked_and_done(parts.input, parts.commands, task + " Then", "mounted");
  clear_screen();
  return is_done;
}

bool is_excluded(const LiveTrials::Parts& parts) {
  return parts.store.excluded_participants().contains(parts.session.row.participant_id);
}

double masking_level_db_fs(const LiveTrials::Parts& parts) {
  return played_noise(parts.live.protocol, parts.live.rig).level_db_fs;
}

std::optional<MaskingInView> masking_in_view(const LiveTrials::Parts& parts) {
  if (!parts.live.protocol.masking) {
    return std::nullopt;
  }
  MaskingInView view{.level_db_fs = masking_level_db_fs(parts)};
  if (parts.masking != nullptr) {
    view.is_playing = parts.masking->is_playing();
    view.underruns = parts.masking->played().underruns;
  }
  return view;
}

// No command is possible once the desk is gone, and each that was given has its outcome said.
class CommandsEnd {
 public:
  explicit CommandsEnd(TypedCommands& commands) : commands_{commands} {}
  ~CommandsEnd() {
    commands_.finish();
    commands_ = TypedCommands{};
  }
  CommandsEnd(const CommandsEnd&) = delete;
  CommandsEnd& operator=(const CommandsEnd&) = delete;
  CommandsEnd(CommandsEnd&&) = delete;
  CommandsEnd& operator=(CommandsEnd&&) = delete;

 private:
  TypedCommands& commands_;
};

std::unique_ptr<Console> console_of(const LiveTrials::Parts& parts, OperatorDesk& desk,
                                    std::function<void()> move_hand) {
  if (!parts.live.console) {
    return nullptr;
  }
  auto console = std::make_unique<Console>(
      *parts.live.console,
      Console::Session{parts.live.protocol, parts.settings.placement, parts.session.row, desk,
                       std::move(move_hand), [parts] { return masking_in_view(parts); }});
  // the terminal's lines are commands then, and the operator may be at a page
  parts.ask_operator = [&desk](const std::string& task) {
    return desk.waits_for_operator(task,
                                   [&] { say("\n{} When that is done, type resume.\n", task); });
  };
  introduce(*console);
  return console;
}

using TellOfMasking = std::function<void(std::string_view state, const std::string& detail)>;

std::optional<MaskedTrialLoop> masked(TrialLoop& loop, const LiveTrials::Parts& parts,
                                      TellOfMasking tell) {
  if (parts.masking == nullptr) {
    return std::nullopt;
  }
  return std::make_optional<MaskedTrialLoop>(
      loop, *parts.masking,
      MaskedTrialLoop::Noise{masking_level_db_fs(parts), parts.live.protocol.masking->is_required,
                             std::move(tell)});
}

TrialLoop& loop_of(TrialLoop& bare, std::optional<MaskedTrialLoop>& masked) {
  return masked ? *masked : bare;
}
}  // namespace

LiveTrials::LiveTrials(const Parts& parts, std::unique_ptr<SessionDevice> device)
    : parts_{parts},
      device_{std::move(device)},
      recorder_{parts.store},
      live_loop_{device_->device(), parts.settings, parts.live.rig.realtime, recorder_},
      masked_loop_{masked(live_loop_, parts, masking_marker())},
      desk_{{parts.live.protocol, parts.session.row.id, is_excluded(parts),
             [this] { return now_s(); },
             [this](const results::OperatorActionRow& action) {
               send({action.session_id, action.t_s, "operator", action.number,
                     fmt::format("{} {}", action.action, action.detail)});
             }},
            recorder_},
      tap_markers_{parts.session.row.id,
                   [this](const results::SessionEventRow& marker) { send(marker); }},
      at_terminal_{parts.input, parts.commands, [this] { get_ready(); }},
      console_{console_of(parts, desk_, [this] { get_ready(); })},
      states_{parts.session.row.id, [this] { return now_s(); },
              [this](const results::SessionEventRow& change) {
                trial_ = change.number.value_or(0);
                send(change);
                if (console_) {
                  console_->note_state(change);
                }
                if (change.state == name(SessionState::exploring)) {
                  store_presentation();
                }
              }},
      masked_idle_loop_{masked(idle_loop_, parts, masking_marker())},
      real_plates_{parts.live.protocol,
                   [this](const std::string& task) {
                     return console_ ? parts_.ask_operator(task) : is_mounted(parts_, task);
                   },
                   loop_of(idle_loop_, masked_idle_loop_)},
      engine_{{parts.live.protocol, parts.models, loop_of(live_loop_, masked_loop_), real_plates_,
               console_ ? console_->participant() : at_terminal_, desk_, states_,
               parts.session.row.seed,
               [this](const results::EventRow& event, int trial) {
                 send({parts_.session.row.id, now_s(), event.kind, trial,
                       fmt::format("{:g}", event.value)});
               },
               actuator_of(parts.live.protocol, parts.live.rig)},
              recorder_,
              parts.session.earlier} {
  parts_.commands = commands_to(desk_);
  if (parts_.actuator != nullptr) {
    live_loop_.use(*parts_.actuator);
  }
  live_loop_.watch([this](const core::TraceSample& sample, Clock::time_point at) {
    if (console_) {
      console_->watch(sample);
    }
    hear_device();
    parts_.markers.send_force(
        {sample.force_n, std::chrono::nanoseconds{at.time_since_epoch()}.count()});
    tap_markers_.add(sample, std::chrono::duration<double>(at - begun_).count(), trial_);
  });
}

std::function<void(std::string_view, const std::string&)> LiveTrials::masking_marker() {
  return [this](std::string_view state, const std::string& detail) {
    send({parts_.session.row.id, now_s(), std::string{state}, trial_, detail});
  };
}

// Before each trial.
void LiveTrials::get_ready() {
  device_->get_ready();
  hear_device();
  repeat_device();
}

// The participant's terminal is left alone while a trial runs.
void LiveTrials::hear_device() {
  std::string text = device_->text_for_operator();
  if (text == device_says_) {
    return;
  }
  device_says_ = std::move(text);
  is_said_ = device_says_.empty();
  desk_.device_says(device_says_);
  if (console_) {
    repeat_device();
  }
}

void LiveTrials::repeat_device() {
  if (!std::exchange(is_said_, true)) {
    say("\nThe device says: {}\n", device_says_);
  }
}

// Otherwise a presentation would leave no trace if the program were killed in it. The trial does
// not wait for the disk: what it refuses is stored with the trial, or the operator hears of it
// then.
void LiveTrials::store_presentation() {
  recorder_.note(states_.take_events());
}

void LiveTrials::send(const results::SessionEventRow& change) {
  parts_.markers.send(marker_of(change, begun_));
}

double LiveTrials::now_s() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

void LiveTrials::reopen_lost_actuator() {
  if (parts_.actuator && parts_.actuator->loss()) {
    const protocols::Protocol& protocol = parts_.live.protocol;
    const protocols::Rig& rig = parts_.live.rig;
    parts_.actuator.reset();  // only one can hold the card
    parts_.actuator = actuator_player(*actuator_of(protocol, rig), protocol, rig);
    live_loop_.use(*parts_.actuator);
  }
}

void LiveTrials::run() {
  std::optional<OperatorTerminal> terminal;
  if (console_) {
    terminal.emplace(parts_.input, desk_, console_->api());
  }
  const CommandsEnd commands_end{parts_.commands};
  while (const auto interruption = engine_.run(parts_.session.schedule, parts_.session.done)) {
    device_ = reconnect(to_text(*interruption), parts_.device_request, std::move(device_));
    device_->begin_session(parts_.session.row.seed);
    live_loop_.use(device_->device());
    const bool is_off = device_->device().zero_force() == device::StopOutcome::confirmed;
    desk_.force_is(is_off ? ForceState::off : ForceState::unknown);
    reopen_lost_actuator();
  }
}
}  // namespace tapstudy::runner
