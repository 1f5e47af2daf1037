#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>

#include "core/output_file.hpp"
#include "device/spidar/calibration_procedure.hpp"
#include "device/spidar/find_spidars.hpp"
#include "protocols/spidar_calibration.hpp"
#include "runner/commands/commands.hpp"
#include "runner/terminal/operator_at_terminal.hpp"
#include "runner/terminal/stop_signal.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::chrono::milliseconds max_reply{100};

struct CalibrateOptions {
  std::string type;
  std::string out;
};

void run_calibrate(const CalibrateOptions& options) {
  device::spidar_geometry(options.type);
  core::check_is_new(options.out);
  const device::UsbListing listing = device::find_only_spidar();
  listen_for_stop();
  device::OpenBoard open{listing, max_reply};
  LineInput input{STDIN_FILENO};
  OperatorAtTerminal person{input};
  fmt::print(stderr,
             "You need a ruler and a force gauge. Strings are numbered as in the frame's drawing, "
             "from 1;\nonly the string being measured pulls, and only with little "
             "force.\n");
  const core::SpidarCalibration calibration =
      device::calibrate_spidar(*open.board, open.pipe, person);
  core::write_new_file(options.out, [&](std::ostream& out) {
    protocols::write_calibration(out, options.type, calibration);
  });
  fmt::print("{}\n", options.out);
}
}  // namespace

void add_calibrate(CommandParser& line) {
  Command command =
      line.add("calibrate", "Measure the strings of the SPIDAR-G6 that is plugged in");
  const auto options = std::make_shared<CalibrateOptions>();
  command.option("--type", options->type, "Type of the frame: X3R or X3L", Need::required);
  command.option("--out", options->out, "The calibration file to write", Need::required);
  command.on_run([options] { run_calibrate(*options); });
}
}  // namespace tapstudy::runner
