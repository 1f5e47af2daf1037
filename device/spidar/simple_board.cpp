#include "device/spidar/simple_board.hpp"

#include "device/spidar/little_endian.hpp"
namespace tapstudy::device {
namespace {
constexpr std::uint8_t encoders = 0xA2;
constexpr std::uint8_t direction_lines = 0x1A;
constexpr std::uint8_t clear = 0x19;
constexpr std::uint8_t all_strings = 0xFF;
constexpr std::uint8_t set_outputs = 0x52;
constexpr std::uint8_t latch = 0x51;
constexpr std::size_t simple_lines_at = 24;

SimpleBoard::Packet command(std::uint8_t first, std::uint8_t second = 0,
                            std::uint8_t third = 0) noexcept {
  return {first, second, third};
}
}  // namespace

SimpleBoard::Packet SimpleBoard::outputs(const DacCounts& dac_counts) noexcept {
  Packet packet = command(set_outputs);
  for (std::size_t i = 0; i < dac_counts.size(); ++i) {
    put_u16(packet, 1 + 2 * i, dac_counts[i]);
  }
  return packet;
}

BoardReading SimpleBoard::reading_of(const Packet& reply) noexcept {
  BoardReading reading;
  for (std::size_t i = 0; i < reading.counter.size(); ++i) {
    reading.counter[i] = get_u24(reply, 3 * i);
  }
  reading.lines = reply[simple_lines_at];
  return reading;
}

UsbOutcome SimpleBoard::begin(UsbPipe& pipe, BoardReading& reading) noexcept {
  pipe.clear_halt();
  pipe.drain();
  const UsbOutcome outcome = pipe.send(command(encoders, direction_lines, all_strings));
  if (outcome != UsbOutcome::ok) {
    return outcome;
  }
  if (const UsbOutcome cleared = pipe.send(command(encoders, clear, all_strings));
      cleared != UsbOutcome::ok) {
    return cleared;
  }
  return exchange(pipe, DacCounts{}, reading);
}

UsbOutcome SimpleBoard::exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                                 BoardReading& reading) noexcept {
  if (const UsbOutcome outcome = pipe.send(outputs(dac_counts)); outcome != UsbOutcome::ok) {
    return outcome;
  }
  const UsbOutcome outcome = pipe.exchange(command(latch), reply_);
  if (outcome == UsbOutcome::ok) {
    reading = reading_of(reply_);
  }
  return outcome;
}

UsbOutcome SimpleBoard::receive(UsbPipe& pipe, BoardReading& reading) noexcept {
  const UsbOutcome outcome = pipe.receive(reply_);
  if (outcome == UsbOutcome::ok) {
    reading = reading_of(reply_);
  }
  return outcome;
}

std::vector<std::uint8_t> SimpleBoard::zero_force_packet() const {
  const Packet packet = outputs({});
  return {packet.begin(), packet.end()};
}
}  // namespace tapstudy::device
