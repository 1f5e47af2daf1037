#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "core/files/output_files.hpp"
#include "core/files/sha256.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/session/devices/rigs.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/shares/share_file.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
struct SimulateOptions {
  SimulatedStudy study{};
  std::string participants{};
  std::string seed{"1"};
  std::string share{};
  bool leaves_traces_out{false};
};

void simulate_and_tell(const SimulatedStudy& study, const protocols::Protocol& protocol,
                       const std::string& out) {
  const SimulatedTime time = simulate(study, protocol);
  const SharedOut part = part_of(study.share, study.participants, "participants");
  fmt::print(
      "{} simulated participants, {} trials, {:.0f} s of tapping in {:.2f} s ({:.0f} × real "
      "time)\n{}/study.db\n",
      part.end - part.first, time.trials, time.tapped_s, time.wall_s, time.tapped_s / time.wall_s,
      out);
}

// A share has its directory when it is complete: what a killed program leaves is none.
void simulate_share(SimulatedStudy study, const protocols::Protocol& protocol) {
  SharedSimulation share = shared_simulation(study.share, protocol);
  share.participants = study.participants;
  share.seed = study.seed;
  share.keeps_traces = study.keeps_traces;
  if (!study.rig_file.empty()) {
    share.inputs += " " + core::sha256(read_rig(study.rig_file).text);
  }
  const std::string out = study.directory;
  write_complete_share(out, share, [&](const std::string& unfinished) {
    study.directory = unfinished;
    simulate_and_tell(study, protocol, out);
    return std::vector<ResultsOfStudy>{};
  });
}

void run_simulate(const SimulateOptions& options) {
  SimulatedStudy study = options.study;
  study.keeps_traces = !options.leaves_traces_out;
  study.seed = seed_from(options.seed, "--seed");
  const protocols::Protocol protocol =
      protocol_to_go_on_with(study.protocol_file, {}, study.directory);
  check_has_blocks(protocol);
  study.participants = planned_participants(options.participants, protocol);
  check_trial_length(protocol);
  listen_for_stop();
  study.progress = fmt::format("simulating {} participants", study.participants);
  if (options.share.empty()) {
    simulate_and_tell(study, protocol, study.directory);
  } else {
    study.share = share_from(options.share);
    simulate_share(study, protocol);
  }
}
}  // namespace

void add_simulate(CommandParser& line) {
  Command command = line.add("simulate", "The whole study with simulated participants");
  const auto options = std::make_shared<SimulateOptions>();
  SimulatedStudy& study = options->study;
  command.shipped_file("protocol", study.protocol_file, "Study (YAML)");
  command.option("--participants", options->participants, participants_help);
  command.option_with_default("--seed", options->seed, "Seed of all random streams");
  command.option(
      "--rig", study.rig_file,
      "Rig (YAML) of the simulated hand: its limits, and an actuator that is rendered with "
      "it");
  command.option("--out", study.directory, "Directory of the study", Need::required);
  command.flag("--no-traces", options->leaves_traces_out,
               "Store answers and events only: faster and smaller, for questions of power");
  command.option("--share", options->share,
                 "K/N: only the participants of share K of N, as they are in the whole; `merge` "
                 "puts the shares together");
  command.on_run([options] { run_simulate(*options); });
}
}  // namespace tapstudy::runner
