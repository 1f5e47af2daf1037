#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <vector>

#include "runner/commands/command_line.hpp"
#include "runner/commands/shared_options.hpp"
#include "runner/laboratory/reproduce/reproduction_report.hpp"
#include "runner/terminal/process_exit.hpp"
namespace tapstudy::runner {
namespace {
struct ReproduceOptions {
  std::string out;
  std::string seed{"1"};
  bool is_quick{false};
  std::vector<std::string> only;
};

void run_reproduce(const ReproduceOptions& options) {
  Bench bench;
  bench.effort = options.is_quick ? Effort::quick : Effort::full;
  bench.seed = seed_from(options.seed, "--seed");
  claim_groups_named(options.only);
  create_reproduction_directory(options.out);
  listen_for_stop();
  const Reproduction reproduction = reproduce(bench, options.only);
  write_files(options.out, reproduction);
  print(reproduction);
  fmt::print("{0}/reproduction.html\n{0}/reproduction.json\n", options.out);
}
}  // namespace

void add_reproduce(CommandParser& line) {
  Command command = line.add("reproduce", "Each claim of the paper beside what tapstudy gets");
  const auto options = std::make_shared<ReproduceOptions>();
  command.option("--out", options->out,
                 "Write reproduction.html and reproduction.json into this directory",
                 Need::required);
  command.list("--only", options->only,
               fmt::format("Groups of claims alone: {}", fmt::join(claim_group_names(), ", ")));
  command.flag("--quick", options->is_quick,
               "With fewer simulated participants: less accurate, but faster");
  command.option_with_default("--seed", options->seed, "Seed of all random streams");
  command.on_run([options] { run_reproduce(*options); });
}
}  // namespace tapstudy::runner
