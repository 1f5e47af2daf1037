#pragma once
#include <cstdint>
#include <span>
namespace tapstudy::device {
enum class UsbOutcome : std::uint8_t {
  ok,
  timed_out,     // no reply in time
  short_packet,  // or one that is too long
  stalled,
  gone,  // unplugged
  failed
};
const char* to_text(UsbOutcome outcome) noexcept;

// One bulk endpoint each way, seen from the haptic thread. Bounded in time; does not throw.
class UsbPipe {
 public:
  virtual ~UsbPipe() = default;
  // Sends all of out.
  [[nodiscard]] virtual UsbOutcome send(std::span<const std::uint8_t> out) noexcept = 0;
  // Sends all of out while waiting for a reply as long as in.
  [[nodiscard]] virtual UsbOutcome exchange(std::span<const std::uint8_t> out,
                                            std::span<std::uint8_t> in) noexcept = 0;
  // Takes replies that nobody asked for out of the way.
  virtual void drain() noexcept = 0;
};
}  // namespace tapstudy::device
