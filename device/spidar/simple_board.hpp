#pragma once
#include "device/spidar/board.hpp"
namespace tapstudy::device {
// CyVerse USB 2.0 "Simple" (0CEC:0203): commands of 32 bytes, one reply of 32 bytes a tick.
//   A2 1A mm: direction of the encoders, a bit each   A2 19 mm: clear the counters
//   52, then 8 × i16 little-endian: outputs           51: latch, and reply with
//   3i: counter i, 24 bits little-endian               24: lines, the rotary switch in bits 4 to 7
class SimpleBoard final : public SpidarBoard {
 public:
  static constexpr std::size_t packet_bytes = 32;
  using Packet = std::array<std::uint8_t, packet_bytes>;
  static Packet outputs(const DacCounts& dac_counts) noexcept;
  static BoardReading reading_of(const Packet& reply) noexcept;

  const char* name() const noexcept override { return "Simple"; }
  int counter_bits() const noexcept override { return 24; }
  UsbOutcome begin(UsbPipe& pipe, BoardReading& reading) noexcept override;
  std::vector<std::uint8_t> zero_force_packet() const override;
  UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                      BoardReading& reading) noexcept override;
  UsbOutcome receive(UsbPipe& pipe, BoardReading& reading) noexcept override;

 private:
  Packet reply_{};
};
}  // namespace tapstudy::device
