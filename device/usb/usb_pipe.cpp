#include "device/usb/usb_pipe.hpp"
namespace tapstudy::device {
const char* to_text(UsbOutcome outcome) noexcept {
  switch (outcome) {
    case UsbOutcome::ok:
      return "ok";
    case UsbOutcome::timed_out:
      return "no reply in time";
    case UsbOutcome::short_packet:
      return "a reply of the wrong length";
    case UsbOutcome::stalled:
      return "the endpoint stalled";
    case UsbOutcome::gone:
      return "the device is gone";
    case UsbOutcome::failed:
      return "the transfer failed";
  }
  return "";
}
}  // namespace tapstudy::device
