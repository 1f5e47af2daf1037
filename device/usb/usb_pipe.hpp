#pragma once
#include <cstdint>
#include <span>
namespace tapstudy::device {
enum class UsbOutcome : std::uint8_t {
  ok,
  timed_out,     // no reply in time
  short_packet,  // or too long
  stalled,
  gone,  // unplugged
  failed
};
const char* to_text(UsbOutcome outcome) noexcept;

// One bulk endpoint per direction, for the haptic thread. Bounded in time; does not throw.
class UsbPipe {
 public:
  virtual ~UsbPipe() = default;
  // Sends all of out.
  [[nodiscard]] virtual UsbOutcome send(std::span<const std::uint8_t> out) noexcept = 0;
  // Sends all of out while waiting for a reply as long as in.
  [[nodiscard]] virtual UsbOutcome exchange(std::span<const std::uint8_t> out,
                                            std::span<std::uint8_t> in) noexcept = 0;
  // Waits for one more reply, as long as in.
  [[nodiscard]] virtual UsbOutcome receive(std::span<std::uint8_t> in) noexcept = 0;
  // Makes halted endpoints usable again.
  virtual void clear_halt() noexcept = 0;
  // Discards stale replies; waits for them for about a millisecond each.
  virtual void drain() noexcept = 0;
};
}  // namespace tapstudy::device
