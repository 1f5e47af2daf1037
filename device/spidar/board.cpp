#include "device/spidar/board.hpp"

#include "device/spidar/sh4_board.hpp"
#include "device/spidar/simple_board.hpp"
namespace tapstudy::device {
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
