#pragma once
#include "device/spidar/board.hpp"
namespace tapstudy::device {
// CyVerse USB 2.0 SH4 amplifier (0CEC:0205): one request of 512 bytes, one reply of 512 bytes.
//   request  0: 0x01, update all   1: 0x0E   2 + 2i: output i, u16, little-endian   the rest: 0
//   reply    2i: output i echoed   16 + 2i: counter i   32 + 2i: voltage of motor i  48: lines
class Sh4Board final : public SpidarBoard {
 public:
  static constexpr std::size_t packet_bytes = 512;
  using Packet = std::array<std::uint8_t, packet_bytes>;
  static Packet request(const DacCounts& dac_counts) noexcept;
  static BoardReading reading_of(const Packet& reply) noexcept;

  const char* name() const noexcept override { return "SH4"; }
  int counter_bits() const noexcept override { return 16; }
  UsbOutcome begin(UsbPipe& pipe, BoardReading& reading) noexcept override;
  std::vector<std::uint8_t> zero_force_packet() const override;
  UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                      BoardReading& reading) noexcept override;
  UsbOutcome receive(UsbPipe& pipe, BoardReading& reading) noexcept override;

 private:
  Packet reply_{};
};
}  // namespace tapstudy::device
