#include "runner/command_line.hpp"

#include <fmt/format.h>

#include <string_view>

#include "runner/build_info.hpp"
#include "runner/commands/commands.hpp"
namespace tapstudy::runner {
ExitCode run_command_line(int argc, const char* const* argv) {
  CommandParser line{"User studies of tapped virtual objects, from a YAML protocol to the report.",
                     "tapstudy", fmt::format("tapstudy {} ({})", program_version(), git_hash())};
  add_check(line);
  add_run(line);
  add_simulate(line);
  add_report(line);
  add_export(line);
  add_amend(line);
  add_redact(line);
  add_verify(line);
  add_modes(line);
  add_tap(line);
  add_trade(line);
  add_reproduce(line);
  add_identify(line);
  add_devices(line);
  add_doctor(line);
  add_calibrate(line);
  if (argc == 3 && std::string_view{argv[1]} == "--documents") {  // for the build: not in --help
    write_command_documents(line.definition(), argv[2]);
    return ExitCode::done;
  }
  return line.parse(argc, argv);
}
}  // namespace tapstudy::runner
