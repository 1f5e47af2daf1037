#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <sstream>

#include "core/files/output_files.hpp"
#include "device/spidar/calibration_procedure.hpp"
#include "device/spidar/find_spidars.hpp"
#include "protocols/reader/read_rig.hpp"
#include "runner/commands/command_line.hpp"
#include "runner/terminal/operator_dialogue.hpp"
#include "runner/terminal/process_exit.hpp"
#include "runner/terminal/terminal_output.hpp"
namespace tapstudy::runner {
namespace {
struct CalibrateOptions {
  std::string type;
  std::string out;
  std::string relay;
};

void run_calibrate(const CalibrateOptions& options) {
  device::spidar_geometry(options.type);
  core::check_is_new(options.out);
  const device::UsbListing listing = device::find_only_spidar();
  listen_for_stop();
  // the terminal is polled less often than a haptic loop beats
  device::OpenBoard open{listing, {.max_stall_s = 0.5, .relay = options.relay}};
  LineInput input{STDIN_FILENO};
  OperatorAtTerminal person{input};
  say("You need a ruler and a force gauge. Strings are numbered as in the frame's drawing, "
      "from 1;\nonly the string being measured pulls, and only with little "
      "force.\n");
  device::MonotonicClock clock;
  const core::SpidarCalibration calibration =
      device::calibrate_spidar(*open.board, open.pipe, open.guardian.channel(), clock, person);
  std::ostringstream text;
  protocols::write_calibration(text, options.type, calibration);
  core::write_all_or_none({{options.out, text.str()}}, core::Existing::kept);
  fmt::print("{}\n", options.out);
}
}  // namespace

void add_calibrate(CommandParser& line) {
  Command command =
      line.add("calibrate", "Measure the strings of the SPIDAR-G6 that is plugged in");
  const auto options = std::make_shared<CalibrateOptions>();
  command.option("--type", options->type, "Type of the frame: X3R or X3L", Need::required);
  command.option("--out", options->out, "The calibration file to write", Need::required);
  command.option("--relay", options->relay, "Serial port of a dead-man relay, as in the rig");
  command.on_run([options] { run_calibrate(*options); });
}
}  // namespace tapstudy::runner
