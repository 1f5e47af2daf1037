#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "runner/commands/commands.hpp"
#include "runner/plugged_in.hpp"
namespace tapstudy::runner {
namespace {
std::string name_of(const device::UsbListing& listing) {
  return is_spidar(listing)
             ? fmt::format("SPIDAR-G6, {} board", device::board_of(listing.product)->name())
             : std::string{};
}

void run_devices() {
  int found = 0;
  for (const device::UsbListing& listing : device::usb_devices()) {
    if (const std::string name = name_of(listing); !name.empty()) {
      fmt::print(
          "{:04x}:{:04x}  {}  {}{}\n", listing.vendor, listing.product, listing.node, name,
          listing.may_open ? "" : "  (no permission: install device/udev/70-tapstudy.rules)");
      ++found;
    }
  }
  if (found == 0) {
    fmt::print("no device that tapstudy knows is plugged in (a simulated hand is always there)\n");
  }
}
}  // namespace

void add_devices(CLI::App& app) {
  app.add_subcommand("devices", "What is plugged in")->callback(run_devices);
}
}  // namespace tapstudy::runner
