#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/session/engine/session_row.hpp"
#include "runner/studies/simulated_study.hpp"
#include "runner/studies/stored_study.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
void run_simulate(SimulatedStudy study, const std::string& participants) {
  const protocols::Protocol protocol =
      protocol_to_go_on_with(study.protocol_file, {}, study.directory);
  check_has_blocks(protocol);
  study.participants = planned_participants(participants, protocol);
  check_trial_length(protocol);
  listen_for_stop();
  study.progress = fmt::format("simulating {} participants", study.participants);
  const SimulatedTime time = simulate(study, protocol);
  fmt::print(
      "{} simulated participants, {} trials, {:.0f} s of tapping in {:.2f} s ({:.0f} × real "
      "time)\n{}/study.db\n",
      study.participants, time.trials, time.tapped_s, time.wall_s, time.tapped_s / time.wall_s,
      study.directory);
}
}  // namespace

void add_simulate(CommandParser& line) {
  Command command = line.add("simulate", "The whole study with simulated participants");
  const auto study = std::make_shared<SimulatedStudy>();
  const auto seed = std::make_shared<std::string>("1");
  const auto participants = std::make_shared<std::string>();
  command.shipped_file("protocol", study->protocol_file, "Study (YAML)");
  command.option("--participants", *participants, participants_help);
  command.option_with_default("--seed", *seed, "Seed of all random streams");
  command.option("--out", study->directory, "Directory of the study", Need::required);
  const auto leaves_traces_out = std::make_shared<bool>(false);
  command.flag("--no-traces", *leaves_traces_out,
               "Store answers and events only: faster and smaller, for questions of power");
  command.on_run([study, participants, seed, leaves_traces_out] {
    study->keeps_traces = !*leaves_traces_out;
    study->seed = seed_from(*seed, "--seed");
    run_simulate(*study, *participants);
  });
}
}  // namespace tapstudy::runner
