#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "protocols/read_protocol.hpp"
#include "protocols/read_rig.hpp"
#include "runner/commands/commands.hpp"
#include "runner/console_participant.hpp"
#include "runner/doctor/diagnosis.hpp"
#include "runner/logging.hpp"
#include "runner/only_one.hpp"
#include "runner/repaired_device.hpp"
#include "runner/rig.hpp"
#include "runner/seed.hpp"
#include "runner/session.hpp"
#include "runner/session_device.hpp"
#include "runner/stop_signal.hpp"
#include "runner/trial_engine.hpp"
namespace tapstudy::runner {
namespace {
constexpr double glance_s = 0.5;  // at the machine, before the first trial

struct RunOptions {
  std::string protocol;
  std::string participant;
  std::string directory;
  std::string rig;
  std::string seed;
  bool resume{false};
  bool pilot{false};
};

std::uint64_t fresh_seed() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source();
}

struct OpenedSession {
  results::SessionRow row;
  protocols::Schedule schedule;
  std::set<int> done;
};

// What the session has around it, measured before its first trial.
struct Surroundings {
  std::string device;
  Diagnosis diagnosis;
};

// A new session, or one that goes on with the order of the participant's last.
OpenedSession open_session(const RunOptions& options, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, const Surroundings& surroundings,
                           results::Store& store) {
  SessionPlan plan{options.participant,
                   0,
                   options.pilot ? results::Mode::pilot : results::Mode::real,
                   0,
                   surroundings.device,
                   surroundings.diagnosis.idle.realtime,
                   to_json(surroundings.diagnosis)};
  plan.participant_index = store.index_of(plan.participant_id, plan.mode);
  const auto earlier = store.latest_session(plan.participant_id);
  if (earlier && !options.resume) {
    throw core::InvalidInput{
        fmt::format("participant '{}' is in this study already (go on with "
                    "--resume, or choose another id)",
                    options.participant)};
  }
  if (!earlier && options.resume) {
    throw core::InvalidInput{
        fmt::format("participant '{}' has no session to resume", options.participant)};
  }
  plan.seed = earlier                ? earlier->seed
              : options.seed.empty() ? fresh_seed()
                                     : seed_from(options.seed, "--seed");
  OpenedSession session;
  session.schedule = make_schedule(protocol, plan.seed, plan.participant_index);
  session.row = session_row(plan, protocol, rig, session.schedule);
  if (earlier) {
    if (earlier->planned_order != session.row.planned_order) {
      throw core::InvalidInput{
          "--resume: this program would plan another order than the stored "
          "one; resume with the version that began the session"};
    }
    session.row.resumes = earlier->id;
    const std::vector<int> done = store.answered_trials(plan.participant_id);
    session.done = {done.begin(), done.end()};
  }
  store.add_session(session.row);
  return session;
}

Surroundings look_around(const protocols::Rig& rig, SessionDevice* hardware,
                         device::Nanoseconds period) {
  Surroundings surroundings{hardware != nullptr ? hardware->device().description() : rig.device,
                            diagnose(rig.loop, period, glance_s, Under::no_load)};
  if (hardware != nullptr) {
    surroundings.diagnosis.round_trip = hardware->round_trip();
  }
  const Verdict verdict = verdict_of(surroundings.diagnosis);
  if (!verdict.holds) {
    warn(verdict.words + " (recorded with the session; `tapstudy doctor` says more)");
  }
  return surroundings;
}

void run_session(const RunOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  check_has_blocks(protocol);
  check_participant_id(options.participant);
  const protocols::Rig rig =
      options.rig.empty() ? protocols::simulated_rig() : protocols::read_rig(options.rig);
  if (rig.replay && !options.pilot) {
    throw core::InvalidInput{"a replayed hand is no participant: give --pilot too"};
  }
  const device::LoopSettings settings = loop_settings(protocol, rig);
  check_fits(protocol, rig);
  ModelLibrary models;
  models.build_all(protocol);
  if (options.resume) {
    results::Store::open_existing(options.directory);  // or there is nothing to resume
  }
  const OnlyOne only_one{
      std::filesystem::absolute(options.directory).lexically_normal().string() + " " +
          options.participant,
      fmt::format("participant '{}' is in a session of this study right now", options.participant)};
  listen_for_stop();
  LineInput input{STDIN_FILENO};
  std::unique_ptr<SessionDevice> hardware = device_of_rig(rig, protocol.rendering.dt_s, input);
  results::Store store =
      results::Store::open_or_create(options.directory, study_row(protocol, options.protocol));
  OpenedSession session = open_session(options, protocol, rig,
                                       look_around(rig, hardware.get(), settings.period), store);
  if (!hardware) {
    hardware = simulated_device(protocol, settings.placement,
                                core::derived_seed(session.row.seed, core::Purpose::hand));
  }
  ConsoleParticipant participant{input, [&] { hardware->get_ready(); }};
  results::Recorder recorder{store};
  LivePresenter presenter{hardware->device(), settings, realtime_request(rig.loop), recorder};
  TrialEngine engine{protocol, models, presenter, participant, recorder};
  while (const auto interruption = engine.run(session.row.id, session.schedule, session.done)) {
    hardware =
        repaired_device(*interruption, rig, protocol.rendering.dt_s, input, std::move(hardware));
    presenter.use(hardware->device());
  }
  fmt::print("participant {}: all {} trials are stored in {}/study.db\n", options.participant,
             session.schedule.size(), options.directory);
}
}  // namespace

void add_run(CLI::App& app) {
  auto* const command = app.add_subcommand("run", "One participant's session at the terminal");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("protocol", options->protocol, "Study (YAML)")->required();
  command->add_option("--participant", options->participant, "Participant's id")->required();
  command->add_option("--out", options->directory, "Directory of the study")->required();
  command->add_option("--rig", options->rig, "Device and limits (YAML); else a simulated hand");
  command->add_option("--seed", options->seed, "Of the order; else drawn and stored");
  command->add_flag("--resume", options->resume, "Go on with the participant's last session");
  command->add_flag("--pilot", options->pilot, "Mark as a pilot, kept out of reports");
  command->callback([options] { run_session(*options); });
}
}  // namespace tapstudy::runner
