#include "runner/session/live_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include "core/error.hpp"
#include "device/loop/sleep_inhibitor.hpp"
#include "results/recorder.hpp"
#include "runner/devices/device_kind.hpp"
#include "runner/devices/masking_noise.hpp"
#include "runner/devices/reconnect.hpp"
#include "runner/devices/rigs.hpp"
#include "runner/markers/markers.hpp"
#include "runner/participants/console_participant.hpp"
#include "runner/session/given_up_trials.hpp"
#include "runner/session/session_row.hpp"
#include "runner/session/trial_engine.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/no_flow_control.hpp"
#include "runner/terminal/session_lock.hpp"
#include "runner/terminal/stop_signal.hpp"
#include "runner/trial_loop/live_trial_loop.hpp"
#include "runner/trial_loop/masked_trial_loop.hpp"
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

// What plays and what is told beside the trials.
struct Company {
  std::unique_ptr<device::AudioPlayer> masking;  // null: none
  Markers& markers;
};

// Runs the remaining trials, reopening the device after a fault.
void run_trials(const LiveSession& live, const device::LoopSettings& settings, ModelLibrary& models,
                const DeviceRequest& device_request, std::unique_ptr<SessionDevice> device,
                const Company& company, results::Store& store, BegunSession& session) {
  ConsoleParticipant participant{device_request.operator_input, [&] { device->get_ready(); }};
  results::Recorder recorder{store};
  LiveTrialLoop live_loop{device->device(), settings, live.rig.realtime, recorder};
  std::optional<MaskedTrialLoop> masked_loop;
  if (company.masking) {
    masked_loop.emplace(live_loop, *company.masking,
                        played_noise(live.protocol, live.rig).level_db_fs);
  }
  TrialLoop& trial_loop = masked_loop ? static_cast<TrialLoop&>(*masked_loop) : live_loop;
  const auto begun = std::chrono::steady_clock::now();
  SessionStates states{
      session.row.id,
      [begun] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
      },
      [&](const results::SessionEventRow& change) { company.markers.send(change); }};
  TrialEngine engine{live.protocol, models, trial_loop, participant, recorder, states};
  while (const auto interruption = engine.run(session.row.id, session.schedule, session.done)) {
    device = reconnect(to_text(*interruption), device_request, std::move(device));
    device->begin_session(session.row.seed);
    live_loop.use(device->device());
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
  Markers markers{live.rig.markers};
  std::unique_ptr<device::PcmSink> card = open_masking_card(live.protocol, live.rig);
  results::Store store =
      results::Store::open_or_create(live.directory, study_row(live.protocol, live.protocol_file));
  BegunSession session = begin_session(
      request_of(live), live.protocol, live.rig,
      run_preflight(live.rig, *device, settings.period, inhibitor ? inhibitor->outcome() : ""),
      store);
  device->begin_session(session.row.seed);
  const Company company{masking_player(std::move(card), live.protocol, live.rig, session.row.seed),
                        markers};
  run_trials(live, settings, models, device_request, std::move(device), company, store, session);
  const std::size_t given_up =
      given_up_trials(live.protocol, session.row.participant_id, store).size();
  return {session.schedule.size() - given_up, given_up};
}
}  // namespace tapstudy::runner
