#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "device/spidar/counters.hpp"
#include "device/usb/usb_pipe.hpp"
namespace tapstudy::device {
// What goes to the digital-to-analogue converters, one word a string.
using DacCounts = std::array<std::uint16_t, strings>;
inline constexpr std::uint16_t max_dac_counts = 4095;  // the converter's assumed width, 12 bits

struct BoardReading {
  RawCounters counter{};
  std::optional<DacCounts> echo;  // of the counts word that the board got, if it says so
  std::uint16_t lines{};          // parallel inputs; bits 4 to 7 are the rotary switch
  int rotary_switch() const noexcept { return static_cast<int>(lines >> 4U & 0xFU); }
};

// A motor and encoder board on the USB, by its wire format. Facts of the format: the public
// history of Springhead, in own words; to be confirmed on hardware.
class SpidarBoard {
 public:
  virtual ~SpidarBoard() = default;
  virtual const char* name() const noexcept = 0;
  virtual int counter_bits() const noexcept = 0;
  // What the board needs once, and the first exchange, with no force.
  [[nodiscard]] virtual UsbOutcome begin(UsbPipe& pipe, BoardReading& reading) noexcept = 0;
  // Sets all outputs and reads all inputs.
  [[nodiscard]] virtual UsbOutcome exchange(UsbPipe& pipe, const DacCounts& dac_counts,
                                            BoardReading& reading) noexcept = 0;
  // The packet that takes all force off.
  virtual std::vector<std::uint8_t> zero_force_packet() const = 0;
};

inline constexpr std::uint16_t cyverse_vendor = 0x0CEC;
inline constexpr std::uint16_t sh4_product = 0x0205;
inline constexpr std::uint16_t simple_product = 0x0203;

// Nothing for a product that is neither.
std::unique_ptr<SpidarBoard> board_of(std::uint16_t product);
}  // namespace tapstudy::device
