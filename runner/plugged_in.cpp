#include "runner/plugged_in.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
namespace tapstudy::runner {
bool is_spidar(const device::UsbListing& listing) {
  return listing.vendor == device::cyverse_vendor && device::board_of(listing.product) != nullptr;
}

std::vector<device::UsbListing> plugged_in_spidars() {
  std::vector<device::UsbListing> all = device::usb_devices();
  std::erase_if(all, [](const device::UsbListing& one) { return !is_spidar(one); });
  if (all.empty()) {
    throw device::DeviceError{
        "no SPIDAR-G6 is plugged in (0cec:0205 or 0cec:0203; `tapstudy devices` lists what is)"};
  }
  return all;
}

device::UsbListing the_only_spidar() {
  const std::vector<device::UsbListing> all = plugged_in_spidars();
  if (all.size() > 1) {
    throw device::DeviceError{
        fmt::format("{} SPIDAR-G6 are plugged in (leave only the one that is meant)", all.size())};
  }
  return all.front();
}

OpenBoard::OpenBoard(const device::UsbListing& listing, std::chrono::milliseconds longest_reply)
    : node{listing.node},
      board{device::board_of(listing.product)},
      guardian{node, device::BulkEndpoints{}.out, board->no_force()},
      pipe{node, {}, longest_reply} {}
}  // namespace tapstudy::runner
