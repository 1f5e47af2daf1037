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

namespace {
std::optional<DeadManRelay> relay_at(const std::string& port) {
  return port.empty() ? std::nullopt : std::optional<DeadManRelay>{std::in_place, port};
}
}  // namespace

OpenBoard::OpenBoard(const UsbListing& listing, const BoardSettings& settings)
    : node{listing.node},
      board{board_of(listing.product)},
      relay{relay_at(settings.relay)},
      guardian{
          node,
          {BulkEndpoints{}.out, BulkEndpoints{}.in, board->zero_force_packet(),
           settings.max_stall_s, settings.guardian_priority, relay ? relay->descriptor() : -1}},
      pipe{node, {}, settings.max_reply} {}

namespace {
BoardReading read_at_zero_force(OpenBoard& open) {
  BoardReading reading;
  const UsbOutcome outcome = open.board->exchange(open.pipe, {}, reading);
  if (outcome != UsbOutcome::ok) {
    throw DeviceError{fmt::format("SPIDAR-G6: the {} board does not answer: {}", open.board->name(),
                                  to_text(outcome))};
  }
  return reading;
}
}  // namespace

void exchange_zero_force(OpenBoard& open) {
  static_cast<void>(read_at_zero_force(open));
}

int rotary_switch_of(const UsbListing& listing) {
  OpenBoard open{listing};
  open.pipe.clear_halt();
  open.pipe.drain();
  return read_at_zero_force(open).rotary_switch();
}

LatenessCount round_trips(OpenBoard& open) {
  LatenessCount times;
  MonotonicClock clock;
  for (int i = 0; i < asked_times; ++i) {
    const Nanoseconds start = clock.now();
    exchange_zero_force(open);
    times.add(clock.now() - start);
  }
  return times;
}
}  // namespace tapstudy::device
