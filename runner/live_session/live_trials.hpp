#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "device/audio/audio_player.hpp"
#include "results/store/recorder.hpp"
#include "runner/console/console.hpp"
#include "runner/live_session/live_session.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/engine/session_states.hpp"
#include "runner/session/engine/trial_engine.hpp"
#include "runner/session/markers/markers.hpp"
#include "runner/session/operators/operator_desk.hpp"
#include "runner/session/participants/terminal_participant.hpp"
#include "runner/session/trial_loop/live_trial_loop.hpp"
#include "runner/session/trial_loop/real_plates.hpp"
namespace tapstudy::runner {
using AskOperator = std::function<bool(const std::string& task)>;

// The trials of a live session, with everybody and everything that takes part in them: the
// participant at the terminal or at a page, the operator, the device, masking noise, markers.
class LiveTrials {
 public:
  struct Parts {
    const LiveSession& live;
    const device::LoopSettings& settings;
    ModelLibrary& models;
    const DeviceRequest& device_request;
    LineInput& input;              // of the terminal
    TypedCommands& commands;       // typed there; possible from now on
    AskOperator& ask_operator;     // of device_request: changed where there are pages
    device::AudioPlayer* masking;  // nullptr: no noise
    std::unique_ptr<device::ActuatorPlayer>& actuator;  // null: none
    Markers& markers;
    results::Store& store;
    BegunSession& session;
  };
  LiveTrials(const Parts& parts, std::unique_ptr<SessionDevice> device);
  // Runs the remaining trials, reopening the device, and an actuator's card that was lost, after a
  // fault; throws as run_live_session.
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  double now_s() const;                               // from the session's begin
  void send(const results::SessionEventRow& change);  // as a marker
  void store_presentation();
  void get_ready();
  void hear_device();
  void repeat_device();
  void reopen_lost_actuator();
  std::function<void(std::string_view state, const std::string& detail)> masking_marker();

  Parts parts_;
  std::unique_ptr<SessionDevice> device_;
  Clock::time_point begun_{Clock::now()};
  std::atomic<int> trial_{0};  // the latest
  std::string device_says_;    // between trials the engine's thread's, in them the recorder's
  bool is_said_{true};
  results::Recorder recorder_;
  LiveTrialLoop live_loop_;
  std::optional<MaskedTrialLoop> masked_loop_;
  OperatorDesk desk_;
  TapMarkers tap_markers_;
  TerminalParticipant at_terminal_;
  std::unique_ptr<Console> console_;  // null: at the terminal
  SessionStates states_;
  IdleTrialLoop idle_loop_;
  std::optional<MaskedTrialLoop> masked_idle_loop_;
  MountedPlates real_plates_;
  TrialEngine engine_;
};
}  // namespace tapstudy::runner
