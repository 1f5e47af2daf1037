#include "runner/session/live_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <optional>
#include <utility>

#include "core/error.hpp"
#include "device/loop/sleep_inhibitor.hpp"
#include "runner/devices/device_kind.hpp"
#include "runner/devices/masking_noise.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/markers/markers.hpp"
#include "runner/session/given_up_trials.hpp"
#include "runner/session/live_trials.hpp"
#include "runner/session/participant_lock.hpp"
#include "runner/session/session_row.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/no_flow_control.hpp"
#include "runner/terminal/operator_prompt.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
// All checks possible before the device and the store are opened.
void check(const LiveSession& live) {
  check_has_blocks(live.protocol);
  check_participant_id(live.request.participant_id);
  check_fits(live.protocol, live.rig);
  if (live.console) {
    check_can_listen(live.console->address);
  }
  if (live.request.resume == Resume::yes) {
    results::Store::open_existing(live.directory);  // or there is nothing to resume
  }
}

// A hand that is not a participant's makes the session a rehearsal.
SessionRequest request_of(const LiveSession& live) {
  SessionRequest request = live.request;
  if (!kind_of(live.rig).has_participant() && request.mode == results::Mode::real) {
    request.mode = results::Mode::pilot;
    warn(
        "this session is a rehearsal and stored as a pilot: the hand is simulated or replayed "
        "(--rig names a participant's device)");
  }
  return request;
}

void say_what_was_found(const BegunSession& session) {
  if (session.resumed_since_utc.empty()) {
    return;
  }
  const std::size_t done = session.done.size();
  say("participant {} goes on with the session begun {}: {} of {} trials are done, {} left\n",
      session.row.participant_id, session.resumed_since_utc, done, session.schedule.size(),
      session.schedule.size() - done);
}
}  // namespace

LiveOutcome run_live_session(const LiveSession& live) {
  const device::LoopSettings settings = loop_settings(live.protocol, live.rig);
  check(live);
  ModelLibrary models;
  models.build_all(live.protocol);
  const ParticipantLock lock{live.directory, live.request.participant_id};
  listen_for_stop();
  const NoFlowControl no_flow_control{STDIN_FILENO};
  LineInput input{STDIN_FILENO};
  std::optional<device::SleepInhibitor> inhibitor;
  if (live.rig.has_hardware) {
    inhibitor.emplace();
  }
  TypedCommands commands;
  AskOperator ask_operator = [&](const std::string& task) {
    return asked_and_done(input, commands, task);
  };
  const DeviceRequest device_request{live.protocol, live.rig,
                                     [&](const std::string& task) { return ask_operator(task); }};
  std::unique_ptr<SessionDevice> device = kind_of(live.rig).open(device_request);
  Markers markers{live.rig.markers};
  std::unique_ptr<device::PcmSink> card = open_masking_card(live.protocol, live.rig);
  results::Store store =
      results::Store::open_or_create(live.directory, study_row(live.protocol, live.protocol_file));
  BegunSession session = begin_session(
      request_of(live), live.protocol, live.rig,
      run_preflight(live.rig, *device, settings.period, inhibitor ? inhibitor->outcome() : ""),
      store);
  say_what_was_found(session);
  device->begin_session(session.row.seed);
  const auto masking = masking_player(std::move(card), live.protocol, live.rig, session.row.seed);
  LiveTrials{{live, settings, models, device_request, input, commands, ask_operator, masking.get(),
              markers, store, session},
             std::move(device)}
      .run();
  const std::string& id = session.row.participant_id;
  const std::size_t given_up = given_up_trials(live.protocol, id, store).size();
  const std::size_t unneeded = unneeded_trials(live.protocol, id, store).size();
  return {session.schedule.size() - given_up - unneeded, given_up};
}
}  // namespace tapstudy::runner
