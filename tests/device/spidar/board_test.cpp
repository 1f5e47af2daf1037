#include <algorithm>

#include "device/spidar/sh4_board.hpp"
#include "device/spidar/simple_board.hpp"
#include "support/catch.hpp"
#include "support/usb/spidar_on_bus.hpp"
using namespace tapstudy;
using device::DacCounts;
using device::Sh4Board;
using device::SimpleBoard;

TEST_CASE("an SH4 request carries its outputs little-endian from byte 2", "[device][spidar]") {
  const Sh4Board::Packet packet = Sh4Board::request({45, 3031, 0, 4095, 1, 2, 3, 256});
  CHECK(packet[0] == 0x01);
  CHECK(packet[1] == 0x0E);
  CHECK(packet[2] == 0x2D);
  CHECK(packet[3] == 0x00);
  CHECK(packet[4] == 0xD7);
  CHECK(packet[5] == 0x0B);
  CHECK(packet[16] == 0x00);
  CHECK(packet[17] == 0x01);
  CHECK(std::all_of(packet.begin() + 18, packet.end(), [](std::uint8_t b) { return b == 0; }));
}

TEST_CASE("an SH4 reply gives echo, counters and the rotary switch", "[device][spidar]") {
  Sh4Board::Packet reply{};
  reply[0] = 0xD7;
  reply[1] = 0x0B;
  reply[16] = 0xFF;
  reply[17] = 0x7F;
  reply[30] = 0x01;
  reply[31] = 0x80;
  reply[48] = 0xA5;
  const device::BoardReading reading = Sh4Board::reading_of(reply);
  CHECK(reading.echo->at(0) == 3031);
  CHECK(reading.counter[0] == 0x7FFF);
  CHECK(reading.counter[7] == 0x8001);
  CHECK(reading.rotary_switch() == 0xA);
}

TEST_CASE("a Simple board's packets are as its format says", "[device][spidar]") {
  const SimpleBoard::Packet packet = SimpleBoard::outputs({45, 3031, 0, 0, 0, 0, 0, 4095});
  CHECK(packet[0] == 0x52);
  CHECK(packet[1] == 45);
  CHECK(packet[3] == 0xD7);
  CHECK(packet[4] == 0x0B);
  CHECK(packet[15] == 0xFF);
  CHECK(packet[16] == 0x0F);
  SimpleBoard::Packet reply{};
  reply[21] = 0xFE;
  reply[22] = 0xFF;
  reply[23] = 0xFF;
  reply[24] = 0x30;
  const device::BoardReading reading = SimpleBoard::reading_of(reply);
  CHECK(reading.counter[7] == 0xFFFFFE);
  CHECK(reading.rotary_switch() == 3);
  CHECK(!reading.echo);
}

TEST_CASE("a Simple board is set up, then told outputs and asked to latch, in every exchange",
          "[device][spidar][usb]") {
  int latched = 0;
  testing::FakeBus bus{device::cyverse_vendor, device::simple_product,
                       [&](std::span<const std::uint8_t> request) {
                         testing::Bytes reply;
                         if (request[0] == 0x51) {  // the only command with a reply
                           reply.assign(32, 0);
                           reply[0] = static_cast<std::uint8_t>(++latched);
                           reply[24] = 0x50;
                         }
                         return reply;
                       }};
  device::UsbNode node = testing::node_of(bus);
  device::LibusbPipe pipe{node, {}, std::chrono::milliseconds{100}};
  SimpleBoard board;
  device::BoardReading reading;
  REQUIRE(board.begin(pipe, reading) == device::UsbOutcome::ok);
  CHECK(reading.rotary_switch() == 5);
  REQUIRE(board.exchange(pipe, {1, 2, 3, 4, 5, 6, 7, 8}, reading) == device::UsbOutcome::ok);
  CHECK(reading.counter[0] == 2);
  std::vector<std::vector<int>> starts;
  for (const testing::Bytes& request : bus.requests()) {
    CHECK(request.size() == 32);
    starts.push_back({request[0], request[1], request[2]});
  }
  CHECK(starts == std::vector<std::vector<int>>{{0xA2, 0x1A, 0xFF},  // directions
                                                {0xA2, 0x19, 0xFF},  // counters cleared
                                                {0x52, 0, 0},
                                                {0x51, 0, 0},
                                                {0x52, 1, 0},
                                                {0x51, 0, 0}});
  bus.plan(testing::FakeBus::Trouble::missing, 1);
  CHECK(board.exchange(pipe, {}, reading) == device::UsbOutcome::timed_out);
}

TEST_CASE("counters that wrap are followed the shorter way", "[device][spidar]") {
  device::UnwrappedCounters counters{16};
  const auto all = [](std::uint32_t value) {
    device::RawCounters raw{};
    raw.fill(value);
    return raw;
  };
  CHECK(counters.take(all(65530)) == 0);
  CHECK(counters.take(all(5)) == 11);
  CHECK(counters.counts()[0] == 11);
  CHECK(counters.take(all(65530)) == 11);
  CHECK(counters.counts()[7] == 0);
  device::UnwrappedCounters wide{24};
  wide.take(all(0xFFFFFF));
  wide.take(all(1));
  CHECK(wide.counts()[3] == 2);
}

TEST_CASE("a counter that turns many times is followed for all its turns", "[device][spidar]") {
  device::UnwrappedCounters counters{16};
  device::RawCounters raw{};
  std::int64_t truth = 0;
  counters.take(raw);
  for (int i = 0; i < 100000; ++i) {
    truth += i < 60000 ? 300 : -299;
    raw.fill(static_cast<std::uint32_t>(truth & 0xFFFF));
    counters.take(raw);
  }
  CHECK(counters.counts()[0] == truth);
}

TEST_CASE("only boards whose format is known are driven", "[device][spidar]") {
  CHECK(device::board_of(device::sh4_product)->counter_bits() == 16);
  CHECK(device::board_of(device::simple_product)->counter_bits() == 24);
  CHECK(device::board_of(0x8613) == nullptr);
}
