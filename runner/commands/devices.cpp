#include <fmt/format.h>

#include "runner/commands/command_line.hpp"
#include "runner/session/devices/device_kind.hpp"
namespace tapstudy::runner {
namespace {
void run_devices() {
  int found = 0;
  for (const DeviceKind* const kind : device_kinds()) {
    for (const std::string& line : kind->listing()) {
      fmt::print("{}\n", line);
      ++found;
    }
  }
  if (found == 0) {
    fmt::print("no known device is plugged in (the simulated hand is always available)\n");
  }
}
}  // namespace

void add_devices(CommandParser& line) {
  line.add("devices", "List the devices that are plugged in").on_run(run_devices);
}
}  // namespace tapstudy::runner
