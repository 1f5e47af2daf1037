#include "runner/session/live_session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "device/loop/sleep_inhibitor.hpp"
#include "results/recorder.hpp"
#include "runner/console/operator_terminal.hpp"
#include "runner/devices/device_kind.hpp"
#include "runner/devices/reconnect.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/operators/operator_desk.hpp"
#include "runner/participants/console_participant.hpp"
#include "runner/session/given_up_trials.hpp"
#include "runner/session/session_row.hpp"
#include "runner/session/trial_engine.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/no_flow_control.hpp"
#include "runner/terminal/say.hpp"
#include "runner/terminal/session_lock.hpp"
#include "runner/terminal/stop_signal.hpp"
#include "runner/trial_loop/live_trial_loop.hpp"
namespace tapstudy::runner {
namespace {
// All checks possible before the device and the store are opened.
void check(const LiveSession& live) {
  check_has_blocks(live.protocol);
  check_participant_id(live.request.participant_id);
  check_fits(live.protocol, live.rig);
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

SessionLock lock_of(const LiveSession& live) {
  const std::string& id = live.request.participant_id;
  // a link and what it leads to are one study
  return {std::filesystem::weakly_canonical(live.directory).string() + " " + id,
          fmt::format("participant '{}' is in a session of this study right now", id)};
}

void introduce(const Console& console) {
  say("participant's page: {}\noperator's page:    {}\n", console.url(Role::participant),
      console.url(Role::operator_of_session));
  std::vector<std::string_view> names;
  std::ranges::transform(operator_actions(), std::back_inserter(names), &ActionInfo::name);
  say("here: {}, quit\n", fmt::join(names, ", "));
}

// At once, so that the trial's supervisor does not wait for the disk.
std::string obeyed(OperatorDesk& desk, const std::string& command) {
  try {
    const OperatorCommand parsed = parse_operator_command(command);
    desk.post(parsed);
    return fmt::format("{}: accepted", name(parsed.action));
  } catch (const core::InvalidInput& error) {
    return error.what();
  }
}

// Runs the remaining trials, reopening the device after a fault.
void run_trials(const LiveSession& live, const device::LoopSettings& settings, ModelLibrary& models,
                const DeviceRequest& device_request, std::unique_ptr<SessionDevice> device,
                results::Store& store, BegunSession& session) {
  results::Recorder recorder{store};
  LiveTrialLoop trial_loop{device->device(), settings, live.rig.realtime, recorder};
  const auto now_s = [begun = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  SessionStates states{session.row.id, now_s};
  OperatorDesk desk{{live.protocol, session.row.id, now_s}, recorder};
  ConsoleParticipant participant{device_request.operator_input, [&] { device->get_ready(); },
                                 [&](const std::string& command) { return obeyed(desk, command); }};
  std::optional<Console> console;
  if (live.console) {
    console.emplace(*live.console, Console::Session{live.protocol, session.row, desk,
                                                    [&] { device->get_ready(); }});
    trial_loop.watch([&](const core::TraceSample& sample) { console->watch(sample); });
    states.listen([&](const results::SessionEventRow& event) { console->note_state(event); });
    introduce(*console);
  }
  TrialEngine engine{{live.protocol, models, trial_loop,
                      console ? console->participant() : participant, desk, states},
                     recorder};
  const auto run_engine = [&] {
    std::optional<OperatorTerminal> terminal;
    if (console) {
      terminal.emplace(device_request.operator_input, desk);
    }
    return engine.run(session.row.id, session.schedule, session.done);
  };
  while (const auto interruption = run_engine()) {
    device = reconnect(to_text(*interruption), device_request, std::move(device));
    device->begin_session(session.row.seed);
    trial_loop.use(device->device());
  }
}
}  // namespace

LiveOutcome run_live_session(const LiveSession& live) {
  const device::LoopSettings settings = loop_settings(live.protocol, live.rig);
  check(live);
  ModelLibrary models;
  models.build_all(live.protocol);
  const SessionLock lock = lock_of(live);
  listen_for_stop();
  const NoFlowControl no_flow_control{STDIN_FILENO};
  LineInput input{STDIN_FILENO};
  std::optional<device::SleepInhibitor> inhibitor;
  if (live.rig.has_hardware) {
    inhibitor.emplace();
  }
  const DeviceRequest device_request{live.protocol, live.rig, input};
  std::unique_ptr<SessionDevice> device = kind_of(live.rig).open(device_request);
  results::Store store =
      results::Store::open_or_create(live.directory, study_row(live.protocol, live.protocol_file));
  BegunSession session = begin_session(
      request_of(live), live.protocol, live.rig,
      run_preflight(live.rig, *device, settings.period, inhibitor ? inhibitor->outcome() : ""),
      store);
  device->begin_session(session.row.seed);
  run_trials(live, settings, models, device_request, std::move(device), store, session);
  const std::size_t given_up =
      given_up_trials(live.protocol, session.row.participant_id, store).size();
  return {session.schedule.size() - given_up, given_up};
}
}  // namespace tapstudy::runner
