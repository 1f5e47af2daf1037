#include "device/spidar/find_spidars.hpp"

#include <fmt/format.h>

#include "device/device.hpp"
#include "device/loop/tick_clock.hpp"
namespace tapstudy::device {
namespace {
constexpr int asked_times = 200;
}

bool is_spidar(const UsbListing& listing) {
  return listing.vendor == cyverse_vendor && board_of(listing.product) != nullptr;
}

std::vector<UsbListing> find_spidars() {
  std::vector<UsbListing> all = usb_devices();
  std::erase_if(all, [](const UsbListing& one) { return !is_spidar(one); });
  if (all.empty()) {
    throw DeviceError{
        "no SPIDAR-G6 is plugged in (0cec:0205 or 0cec:0203; `tapstudy devices` lists what is)"};
  }
  return all;
}

UsbListing find_only_spidar() {
  const std::vector<UsbListing> all = find_spidars();
  if (all.size() > 1) {
    throw DeviceError{
        fmt::format("{} SPIDAR-G6 are plugged in (leave only the intended one)", all.size())};
  }
  return all.front();
}

OpenBoard::OpenBoard(const UsbListing& listing, std::chrono::milliseconds max_reply)
    : node{listing.node},
      board{board_of(listing.product)},
      guardian{node, BulkEndpoints{}.out, board->zero_force_packet()},
      pipe{node, {}, max_reply} {}

LatenessCount round_trips(OpenBoard& open) {
  LatenessCount times;
  MonotonicClock clock;
  for (int i = 0; i < asked_times; ++i) {
    const Nanoseconds start = clock.now();
    BoardReading ignored;
    const UsbOutcome outcome = open.board->exchange(open.pipe, {}, ignored);
    if (outcome != UsbOutcome::ok) {
      throw DeviceError{fmt::format("SPIDAR-G6: the {} board does not answer: {}",
                                    open.board->name(), to_text(outcome))};
    }
    times.add(clock.now() - start);
  }
  return times;
}

LatenessCount probed_round_trip(const UsbListing& listing) {
  OpenBoard open{listing, std::chrono::milliseconds{100}};
  open.pipe.drain();
  return round_trips(open);
}
}  // namespace tapstudy::device
