#include "runner/plugged_in.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
#include "device/tick_clock.hpp"
namespace tapstudy::runner {
namespace {
constexpr int asked_times = 200;
}

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

device::LatenessCount round_trips(OpenBoard& open) {
  device::LatenessCount times;
  device::MonotonicClock clock;
  for (int i = 0; i < asked_times; ++i) {
    const device::Nanoseconds start = clock.now();
    device::BoardReading ignored;
    const device::UsbOutcome outcome = open.board->exchange(open.pipe, {}, ignored);
    if (outcome != device::UsbOutcome::ok) {
      throw device::DeviceError{fmt::format("SPIDAR-G6: the {} board does not answer: {}",
                                            open.board->name(), to_text(outcome))};
    }
    times.add(clock.now() - start);
  }
  return times;
}

device::LatenessCount probed_round_trip(const device::UsbListing& listing) {
  OpenBoard open{listing, std::chrono::milliseconds{100}};
  open.pipe.drain();
  return round_trips(open);
}
}  // namespace tapstudy::runner
