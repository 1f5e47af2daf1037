#include "support/usb/fake_usbfs.hpp"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
namespace tapstudy::testing {
namespace {
constexpr int high_speed = 3;
constexpr std::uint32_t capabilities = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                       USBDEVFS_CAP_BULK_SCATTER_GATHER |
                                       USBDEVFS_CAP_REAP_AFTER_DISCONNECT;

// GET_CONFIGURATION is the one control request there is.
int control(const usbdevfs_ctrltransfer& transfer) {
  constexpr int get_configuration = 8;
  if (transfer.bRequest != get_configuration) {
    return -EPIPE;
  }
  *static_cast<std::uint8_t*>(transfer.data) = 1;
  return 1;
}
}  // namespace

void FakeUsbfs::plan(Trouble trouble, int after, std::chrono::milliseconds delay) {
  planned_ = trouble;
  exchanges_until_trouble_ = after;
  delay_ = delay;
}

FakeUsbfs::Trouble FakeUsbfs::trouble_now() {
  if (planned_ == Trouble::none || exchanges_until_trouble_-- > 0) {
    return lasting_;
  }
  return std::exchange(planned_, Trouble::none);
}

void FakeUsbfs::complete(usbdevfs_urb* urb, int status, int length) {
  urb->status = status;
  urb->actual_length = length;
  done_.push_back(urb);
}

void FakeUsbfs::unplug() {
  is_gone_ = true;
  while (!waiting_.empty()) {
    complete(waiting_.front(), -ESHUTDOWN, 0);
    waiting_.pop_front();
  }
}

void FakeUsbfs::send_back(Bytes reply, Trouble trouble) {
  Reply planned{std::move(reply), 0, now_() + usual_delay_};
  switch (trouble) {
    case Trouble::missing:
      return;
    case Trouble::every_other:
      if (++asked_ % 2 == 0) {
        return;
      }
      break;
    case Trouble::late:
      planned.due = now_() + delay_;
      break;
    case Trouble::short_reply:
      planned.bytes.resize(planned.bytes.size() / 2);
      break;
    case Trouble::stalled:
      planned.status = -EPIPE;
      break;
    case Trouble::protocol:
      planned.status = -EPROTO;
      break;
    case Trouble::overflow:
      planned.status = -EOVERFLOW;
      break;
    case Trouble::stale:
      planned.bytes = last_reply_;
      break;
    case Trouble::unplugged:
      unplug();
      return;
    default:
      break;
  }
  if (trouble != Trouble::stale) {
    last_reply_ = planned.bytes;
  }
  replies_.push_back(std::move(planned));
}

void FakeUsbfs::deliver_what_is_due() {
  while (has_reply_under_way() && replies_.front().due <= now_()) {
    usbdevfs_urb* const urb = waiting_.front();
    const Reply& reply = replies_.front();
    const auto length = std::min(static_cast<std::size_t>(urb->buffer_length), reply.bytes.size());
    std::memcpy(urb->buffer, reply.bytes.data(), length);
    complete(urb, reply.status, reply.status == 0 ? static_cast<int>(length) : 0);
    waiting_.pop_front();
    replies_.pop_front();
  }
}

// Whether the request gets no further than the kernel, or than the bus.
bool FakeUsbfs::is_held_up(usbdevfs_urb* urb, Trouble trouble) {
  if (clears_needed_ > 0) {
    complete(urb, -EPIPE, 0);
    return true;
  }
  if (trouble == Trouble::out_nak) {
    not_taken_.push_back(urb);
    return true;
  }
  if (trouble == Trouble::out_lost) {
    complete(urb, 0, urb->buffer_length);
    return true;
  }
  return false;
}

int FakeUsbfs::clear_halt() {
  clears_needed_ = std::max(0, clears_needed_ - 1);
  return is_gone_ ? -ENODEV : 0;
}

int FakeUsbfs::take_request(usbdevfs_urb* urb) {
  const Trouble trouble = trouble_now();
  if (trouble == Trouble::not_accepted) {
    return -ENOMEM;
  }
  if (is_held_up(urb, trouble)) {
    return 0;
  }
  complete(urb, 0, urb->buffer_length);
  const std::span request{static_cast<const std::uint8_t*>(urb->buffer),
                          static_cast<std::size_t>(urb->buffer_length)};
  if (Bytes reply = board_.answer(request); !reply.empty()) {
    send_back(std::move(reply), trouble);
  } else if (trouble != lasting_) {
    plan(trouble, 0, delay_);  // it comes with the next reply
  }
  return 0;
}

int FakeUsbfs::submit(usbdevfs_urb* urb) {
  if (is_gone_) {
    return -ENODEV;
  }
  int result = 0;
  if (urb->endpoint == out_endpoint) {
    result = take_request(urb);
  } else {
    waiting_.push_back(urb);
  }
  deliver_what_is_due();
  return result;
}

int FakeUsbfs::reap(void** urb) {
  deliver_what_is_due();  // not every program is woken for a late reply: some only ask again
  if (done_.empty()) {
    return is_gone_ ? -ENODEV : -EAGAIN;
  }
  *urb = done_.front();
  done_.pop_front();
  return 0;
}

int FakeUsbfs::discard(const void* urb) {
  for (std::deque<usbdevfs_urb*>* const under_way : {&waiting_, &not_taken_}) {
    if (const auto found = std::ranges::find(*under_way, urb); found != under_way->end()) {
      complete(*found, -ENOENT, 0);
      under_way->erase(found);
      return 0;
    }
  }
  return -EINVAL;
}

void FakeUsbfs::forget_transfers() {
  waiting_.clear();
  not_taken_.clear();
  done_.clear();
}

// Without libusb, and without waiting. A transfer that libusb has under way is served first.
int FakeUsbfs::bulk_in(const usbdevfs_bulktransfer& transfer) {
  deliver_what_is_due();
  if (replies_.empty() || replies_.front().due > now_()) {
    return -ETIMEDOUT;
  }
  const Reply reply = std::move(replies_.front());
  replies_.pop_front();
  const auto length = std::min(static_cast<std::size_t>(transfer.len), reply.bytes.size());
  std::memcpy(transfer.data, reply.bytes.data(), length);
  return reply.status == 0 ? static_cast<int>(length) : reply.status;
}

int FakeUsbfs::bulk(const usbdevfs_bulktransfer& transfer) {
  if (is_gone_) {
    return -ENODEV;
  }
  if (transfer.ep == in_endpoint) {
    return bulk_in(transfer);
  }
  if (clears_needed_ > 0) {
    return -EPIPE;
  }
  if (lasting_ == Trouble::out_nak) {
    return -ETIMEDOUT;
  }
  if (lasting_ != Trouble::out_lost) {
    Bytes reply = board_.answer({static_cast<const std::uint8_t*>(transfer.data), transfer.len});
    if (!reply.empty()) {
      send_back(std::move(reply), lasting_);
      deliver_what_is_due();
    }
  }
  return static_cast<int>(transfer.len);
}

int FakeUsbfs::ioctl(unsigned long request, void* argument) {
  switch (static_cast<unsigned>(request)) {
    case static_cast<unsigned>(USBDEVFS_CONNECTINFO):
      *static_cast<usbdevfs_connectinfo*>(argument) = {address_, 0};
      return 0;
    case static_cast<unsigned>(USBDEVFS_GET_SPEED):
      return high_speed;
    case static_cast<unsigned>(USBDEVFS_GET_CAPABILITIES):
      *static_cast<std::uint32_t*>(argument) = capabilities;
      return 0;
    case static_cast<unsigned>(USBDEVFS_CONTROL):
      return control(*static_cast<const usbdevfs_ctrltransfer*>(argument));
    case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):
      // which endpoint is of no matter: replies never halt for longer than one
      return clear_halt();
    case static_cast<unsigned>(USBDEVFS_GETDRIVER):
      return -ENODATA;
    case static_cast<unsigned>(USBDEVFS_RELEASEINTERFACE):
      forget_transfers();  // as the kernel does
      [[fallthrough]];
    case static_cast<unsigned>(USBDEVFS_CLAIMINTERFACE):
    case static_cast<unsigned>(USBDEVFS_SETINTERFACE):
    case static_cast<unsigned>(USBDEVFS_RESET):
      return is_gone_ ? -ENODEV : 0;
    case static_cast<unsigned>(USBDEVFS_SUBMITURB):
      return submit(static_cast<usbdevfs_urb*>(argument));
    case static_cast<unsigned>(USBDEVFS_REAPURBNDELAY):
      return reap(static_cast<void**>(argument));
    case static_cast<unsigned>(USBDEVFS_DISCARDURB):
      return discard(argument);
    case static_cast<unsigned>(USBDEVFS_BULK):
      return bulk(*static_cast<const usbdevfs_bulktransfer*>(argument));
    default:
      return -ENOTTY;
  }
}
}  // namespace tapstudy::testing
