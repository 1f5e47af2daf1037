#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <random>

#include "core/error.hpp"
#include "core/rng.hpp"
#include "protocols/read_protocol.hpp"
#include "runner/commands/commands.hpp"
#include "runner/console_participant.hpp"
#include "runner/rig.hpp"
#include "runner/seed.hpp"
#include "runner/session.hpp"
#include "runner/simulated/tap_drawing.hpp"
#include "runner/stop_signal.hpp"
#include "runner/trial_engine.hpp"
namespace tapstudy::runner {
namespace {
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

// A new session, or one that goes on with the order of the participant's last.
OpenedSession open_session(const RunOptions& options, const protocols::Protocol& protocol,
                           const protocols::Rig& rig, results::Store& store) {
  SessionPlan plan{options.participant, 0,
                   options.pilot ? results::Mode::pilot : results::Mode::real, 0, rig.device};
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

// A simulated hand that keeps tapping, for a session without a device.
constexpr int taps_without_end = 2000;

void run_session(const RunOptions& options) {
  const protocols::Protocol protocol = protocols::read_protocol(options.protocol);
  check_has_blocks(protocol);
  check_participant_id(options.participant);
  const protocols::Rig rig =
      options.rig.empty() ? protocols::simulated_rig() : protocols::read_rig(options.rig);
  const device::LoopSettings settings = loop_settings(protocol, rig);
  ModelLibrary models;
  models.build_all(protocol);
  if (options.resume) {
    results::Store::open_existing(options.directory);  // or there is nothing to resume
  }
  results::Store store =
      results::Store::open_or_create(options.directory, study_row(protocol, options.protocol));
  const OpenedSession session = open_session(options, protocol, rig, store);
  listen_for_stop();

  device::SimulatedHand hand{hand_body(protocol.simulation.hand), protocol.rendering.dt_s,
                             device::SimulatedHand::Memory::none};
  core::Rng hand_rng{core::derived_seed(session.row.seed, core::Purpose::hand)};
  LineInput input{STDIN_FILENO};
  ConsoleParticipant participant{
      input,
      [&] { hand.follow(draw_taps(protocol, settings.placement, taps_without_end, hand_rng)); }};
  results::Recorder recorder{store};
  LivePresenter presenter{hand, settings, recorder};
  TrialEngine engine{protocol, models, presenter, participant, recorder};
  engine.run(session.row.id, session.schedule, session.done);
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
