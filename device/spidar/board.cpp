#include "device/spidar/board.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
namespace tapstudy::device {
inline void put_u16(std::span<std::uint8_t> bytes, std::size_t at, std::uint16_t value) noexcept {
  bytes[at] = static_cast<std::uint8_t>(value & 0xFFU);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8U);
}
inline std::uint16_t get_u16(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8U);
}
inline std::uint32_t get_u24(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return get_u16(bytes, at) | static_cast<std::uint32_t>(bytes[at + 2]) << 16U;
}

std::int64_t UnwrappedCounters::shorter_way(std::uint32_t from, std::uint32_t to) const noexcept {
  const std::int64_t turn = std::int64_t{1} << bits_;
  const std::int64_t ahead = (std::int64_t{to} - std::int64_t{from}) & (turn - 1);
  return ahead < turn / 2 ? ahead : ahead - turn;
}

std::int64_t UnwrappedCounters::take(const RawCounters& raw) noexcept {
  if (!has_begun_) {
    has_begun_ = true;
    counts_ = {};
    last_ = raw;
    return 0;
  }
  std::int64_t largest = 0;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const std::int64_t step = shorter_way(last_[i], raw[i]);
    counts_[i] += step;
    largest = std::max(largest, std::abs(step));
  }
  last_ = raw;
  return largest;
}

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

ZeroForcePacket Sh4Board::zero_force_packet() const {
  const Packet packet = request({});
  return {{packet.begin(), packet.end()}, {}, packet_bytes, 2 * std::size_t{strings}};
}

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

ZeroForcePacket SimpleBoard::zero_force_packet() const {
  const Packet packet = outputs({});
  const Packet latched = command(latch);
  return {{packet.begin(), packet.end()}, {latched.begin(), latched.end()}, packet_bytes, 0};
}

ZeroExchange exchange_zeros(SpidarBoard& board, UsbPipe& pipe) noexcept {
  BoardReading reading;
  const UsbOutcome outcome = board.exchange(pipe, DacCounts{}, reading);
  if (outcome == UsbOutcome::stalled) {
    pipe.clear_halt();
  }
  return {outcome, outcome == UsbOutcome::ok && reading.echo.value_or(DacCounts{}) == DacCounts{}};
}

std::unique_ptr<SpidarBoard> board_of(std::uint16_t product) {
  if (product == sh4_product) {
    return std::make_unique<Sh4Board>();
  }
  if (product == simple_product) {
    return std::make_unique<SimpleBoard>();
  }
  return nullptr;
}
}  // namespace tapstudy::device
