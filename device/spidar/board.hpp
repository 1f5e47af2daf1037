#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "device/spidar/counters.hpp"
#include "device/usb/usb_pipe.hpp"
namespace tapstudy::device {
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
  // The packet that sets all outputs to zero.
  virtual std::vector<std::uint8_t> zero_force_packet() const = 0;
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
}  // namespace tapstudy::device
