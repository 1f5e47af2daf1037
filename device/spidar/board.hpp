#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "device/spidar/kinematics.hpp"
#include "device/usb/guardian.hpp"
#include "device/usb/usb_pipe.hpp"
namespace tapstudy::device {
using RawCounters = std::array<std::uint32_t, strings>;
using Counts = std::array<std::int64_t, strings>;

// Unwraps free-running encoder counters of the given width to 64 bits: between two readings the
// shorter way round is assumed.
class UnwrappedCounters {
 public:
  explicit UnwrappedCounters(int bits) noexcept : bits_{bits} {}
  // The first reading defines zero. Returns the largest step since the last one.
  std::int64_t take(const RawCounters& raw) noexcept;
  const Counts& counts() const noexcept { return counts_; }
  void forget() noexcept { has_begun_ = false; }

 private:
  std::int64_t shorter_way(std::uint32_t from, std::uint32_t to) const noexcept;
  int bits_;
  bool has_begun_{false};
  RawCounters last_{};
  Counts counts_{};
};

// Values for the digital-to-analogue converters, one word per string.
using DacCounts = std::array<std::uint16_t, strings>;
inline constexpr std::uint16_t max_dac_counts = 4095;  // the converter's assumed width, 12 bits

struct BoardReading {
  RawCounters counter{};
  std::optional<DacCounts> echo;          // of the DAC counts received, if the board echoes them
  std::optional<double> motor_voltage_v;  // mean over the strings, if the board measures it
  std::uint16_t lines{};                  // parallel inputs; bits 4 to 7 are the rotary switch
  int rotary_switch() const noexcept { return static_cast<int>(lines >> 4U & 0xFU); }
};

// A USB motor and encoder board, defined by its wire format. The format is taken from the public
// history of Springhead, not copied; to be confirmed on hardware.
class SpidarBoard {
 public:
  virtual ~SpidarBoard() = default;
  virtual const char* name() const noexcept = 0;
  virtual int counter_bits() const noexcept = 0;
  // Initialises the board and makes the first exchange, with zero force.
  [[nodiscard]] virtual UsbOutcome begin(UsbPipe& pipe, BoardReading& reading) noexcept = 0;
  // Sets all outputs and reads all inputs.
  [[nodiscard]] virtual UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                                            BoardReading& reading) noexcept = 0;
  // Reads one more reply, after one that was left over from an earlier exchange.
  [[nodiscard]] virtual UsbOutcome receive(UsbPipe& pipe, BoardReading& reading) noexcept = 0;
  // For a guardian, which knows no board.
  virtual ZeroForcePacket zero_force_packet() const = 0;
};

// One exchange with zero force. Confirmed by a reply that does not echo anything else; a halt is
// cleared for the next exchange.
struct ZeroExchange {
  UsbOutcome outcome;
  bool is_confirmed;
};
ZeroExchange exchange_zeros(SpidarBoard& board, UsbPipe& pipe) noexcept;

inline constexpr std::uint16_t cyverse_vendor = 0x0CEC;
inline constexpr std::uint16_t sh4_product = 0x0205;
inline constexpr std::uint16_t simple_product = 0x0203;

// nullptr for an unknown product id.
std::unique_ptr<SpidarBoard> board_of(std::uint16_t product);

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
  ZeroForcePacket zero_force_packet() const override;
  UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                      BoardReading& reading) noexcept override;
  UsbOutcome receive(UsbPipe& pipe, BoardReading& reading) noexcept override;

 private:
  Packet reply_{};
};

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
  ZeroForcePacket zero_force_packet() const override;
  UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                      BoardReading& reading) noexcept override;
  UsbOutcome receive(UsbPipe& pipe, BoardReading& reading) noexcept override;

 private:
  Packet reply_{};
};
}  // namespace tapstudy::device
