#include <fmt/format.h>

#include "runner/commands/commands.hpp"
#include "runner/devices/device_kind.hpp"
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
    fmt::print("no device that tapstudy knows is plugged in (a simulated hand is always there)\n");
  }
}
}  // namespace

void add_devices(CommandParser& line) {
  line.add("devices", "What is plugged in").on_run(run_devices);
}
}  // namespace tapstudy::runner
