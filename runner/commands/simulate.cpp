#include <fmt/format.h>

#include <memory>

#include "core/error.hpp"
#include "protocols/read_protocol.hpp"
#include "runner/commands/commands.hpp"
#include "runner/commands/seed.hpp"
#include "runner/experiments/simulated_study.hpp"
#include "runner/session/session_row.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
void run_simulate(const SimulatedStudy& study) {
  const protocols::Protocol protocol = protocols::read_protocol(study.protocol_file);
  check_has_blocks(protocol);
  if (study.participants < 1 || study.participants > 10000) {
    throw core::InvalidInput{
        fmt::format("--participants: {} is not allowed (from 1 to 10000)", study.participants)};
  }
  check_trial_length(protocol);
  listen_for_stop();
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
  study->participants = 10;
  command.argument("protocol", study->protocol_file, "Study (YAML)");
  command.option_with_default("--participants", study->participants, "How many");
  command.option_with_default("--seed", *seed, "Seed of all random streams");
  command.option("--out", study->directory, "Directory of the study", Need::required);
  const auto leaves_traces_out = std::make_shared<bool>(false);
  command.flag("--no-traces", *leaves_traces_out,
               "Store answers and events only: faster and smaller, for questions of power");
  command.on_run([study, seed, leaves_traces_out] {
    study->keeps_traces = !*leaves_traces_out;
    study->seed = seed_from(*seed, "--seed");
    run_simulate(*study);
  });
}
}  // namespace tapstudy::runner
