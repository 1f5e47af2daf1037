#include "device/spidar/sh4_board.hpp"

#include "device/spidar/little_endian.hpp"
namespace tapstudy::device {
namespace {
constexpr std::uint8_t update_all = 0x01;
constexpr std::uint8_t base_analyser = 0x0E;
constexpr std::size_t outputs_at = 2;
constexpr std::size_t echo_at = 0;
constexpr std::size_t counters_at = 16;
constexpr std::size_t voltages_at = 32;
constexpr double volts_per_count = 24.0 / 4096.0;  // published; to be confirmed on hardware
constexpr std::size_t sh4_lines_at = 48;
}  // namespace

Sh4Board::Packet Sh4Board::request(const DacCounts& dac_counts) noexcept {
  Packet packet{};
  packet[0] = update_all;
  packet[1] = base_analyser;
  for (std::size_t i = 0; i < dac_counts.size(); ++i) {
    put_u16(packet, outputs_at + 2 * i, dac_counts[i]);
  }
  return packet;
}

BoardReading Sh4Board::reading_of(const Packet& reply) noexcept {
  BoardReading reading;
  DacCounts echo{};
  double sum_v = 0.0;
  for (std::size_t i = 0; i < echo.size(); ++i) {
    echo[i] = get_u16(reply, echo_at + 2 * i);
    reading.counter[i] = get_u16(reply, counters_at + 2 * i);
    sum_v += volts_per_count * get_u16(reply, voltages_at + 2 * i);
  }
  reading.motor_voltage_v = sum_v / strings;
  reading.echo = echo;
  reading.lines = get_u16(reply, sh4_lines_at);
  return reading;
}

// Stale replies left by an earlier program would offset every reply by one.
UsbOutcome Sh4Board::begin(UsbPipe& pipe, BoardReading& reading) noexcept {
  pipe.clear_halt();
  pipe.drain();
  return exchange(pipe, DacCounts{}, reading);
}

UsbOutcome Sh4Board::exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                              BoardReading& reading) noexcept {
  const UsbOutcome outcome = pipe.exchange(request(dac_counts), reply_);
  if (outcome == UsbOutcome::ok) {
    reading = reading_of(reply_);
  }
  return outcome;
}

UsbOutcome Sh4Board::receive(UsbPipe& pipe, BoardReading& reading) noexcept {
  const UsbOutcome outcome = pipe.receive(reply_);
  if (outcome == UsbOutcome::ok) {
    reading = reading_of(reply_);
  }
  return outcome;
}

std::vector<std::uint8_t> Sh4Board::zero_force_packet() const {
  const Packet packet = request({});
  return {packet.begin(), packet.end()};
}
}  // namespace tapstudy::device
