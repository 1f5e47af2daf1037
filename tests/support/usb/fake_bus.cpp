#include "support/usb/fake_bus.hpp"

#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <map>
#include <utility>
namespace tapstudy::testing {
namespace {
constexpr std::uint64_t full = 0xFFFFFFFFFFFFFFFEULL;  // an eventfd that cannot be written to

std::mutex buses_mutex;
std::map<int, FakeBus*>& buses() {
  static std::map<int, FakeBus*> all;
  return all;
}

int refused(int error) {
  errno = error;
  return -1;
}
}  // namespace

FakeBus::FakeBus(std::uint16_t vendor, std::uint16_t product, Answer answer)
    : descriptor_{eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)},
      descriptors_{descriptors_of(vendor, product)},
      answer_{std::move(answer)} {
  const std::lock_guard lock{buses_mutex};
  buses()[descriptor_] = this;
}

FakeBus::~FakeBus() {
  const std::lock_guard lock{buses_mutex};
  buses().erase(descriptor_);
  if (!is_open_) {
    close(descriptor_);
  }
}

int FakeBus::open() {
  is_open_ = true;
  return descriptor_;
}

FakeBus* FakeBus::of(int descriptor) {
  const std::lock_guard lock{buses_mutex};
  const auto found = buses().find(descriptor);
  return found == buses().end() ? nullptr : found->second;
}

void FakeBus::plan(Trouble trouble, int after, std::chrono::milliseconds delay) {
  const std::lock_guard lock{mutex_};
  planned_ = trouble;
  exchanges_until_trouble_ = after;
  delay_ = delay;
}

std::vector<Bytes> FakeBus::requests() const {
  const std::lock_guard lock{mutex_};
  return requests_;
}

void FakeBus::forget_requests() {
  const std::lock_guard lock{mutex_};
  requests_.clear();
}

FakeBus::Trouble FakeBus::trouble_now() {
  if (planned_ == Trouble::none || exchanges_until_trouble_-- > 0) {
    return Trouble::none;
  }
  return std::exchange(planned_, Trouble::none);
}

void FakeBus::complete(usbdevfs_urb* urb, int status, int length) {
  urb->status = status;
  urb->actual_length = length;
  done_.push_back(urb);
}

void FakeBus::drop_pending() {
  while (!waiting_.empty()) {
    complete(waiting_.front(), -ESHUTDOWN, 0);
    waiting_.pop_front();
  }
}

void FakeBus::unplug() {
  const std::lock_guard lock{mutex_};
  is_gone_ = true;
  drop_pending();
  show_whether_done();
}

// libusb waits for the descriptor to become writable.
void FakeBus::show_whether_done() {
  const bool is_done = !done_.empty() || is_gone_;
  std::uint64_t value = full;
  if (is_done && is_blocked_) {
    is_blocked_ = syscall(SYS_read, descriptor_, &value, sizeof value) != sizeof value;
  } else if (!is_done && !is_blocked_) {
    is_blocked_ = syscall(SYS_write, descriptor_, &value, sizeof value) == sizeof value;
  }
}

void FakeBus::answer(Bytes reply, Trouble trouble) {
  Reply planned{std::move(reply)};
  switch (trouble) {
    case Trouble::missing:
      return;
    case Trouble::late:
      planned.due = Clock::now() + delay_;
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
      is_gone_ = true;
      drop_pending();
      return;
    default:
      break;
  }
  if (trouble != Trouble::stale) {
    last_reply_ = planned.bytes;
  }
  replies_.push_back(std::move(planned));
}

void FakeBus::deliver() {
  while (!waiting_.empty() && !replies_.empty() && replies_.front().due <= Clock::now()) {
    usbdevfs_urb* const urb = waiting_.front();
    const Reply& reply = replies_.front();
    const auto length = std::min(static_cast<std::size_t>(urb->buffer_length), reply.bytes.size());
    std::memcpy(urb->buffer, reply.bytes.data(), length);
    complete(urb, reply.status, reply.status == 0 ? static_cast<int>(length) : 0);
    waiting_.pop_front();
    replies_.pop_front();
  }
}

void FakeBus::deliver_what_is_due() {
  const std::lock_guard lock{mutex_};
  deliver();
  show_whether_done();
}

int FakeBus::take_request(usbdevfs_urb* urb) {
  const Trouble trouble = trouble_now();
  if (trouble == Trouble::not_accepted) {
    return refused(ENOMEM);
  }
  const auto* const bytes = static_cast<const std::uint8_t*>(urb->buffer);
  const std::span request{bytes, static_cast<std::size_t>(urb->buffer_length)};
  if (keeps_requests_) {
    requests_.emplace_back(request.begin(), request.end());
  }
  complete(urb, 0, urb->buffer_length);
  if (Bytes reply = answer_(request); !reply.empty()) {
    answer(std::move(reply), trouble);
  }
  return 0;
}

int FakeBus::submit(usbdevfs_urb* urb) {
  if (is_gone_) {
    return refused(ENODEV);
  }
  int result = 0;
  if (urb->endpoint == out_endpoint) {
    result = take_request(urb);
  } else {
    waiting_.push_back(urb);
  }
  deliver();
  show_whether_done();
  return result;
}

int FakeBus::reap(void** urb) {
  if (done_.empty()) {
    show_whether_done();
    return refused(is_gone_ ? ENODEV : EAGAIN);
  }
  *urb = done_.front();
  done_.pop_front();
  show_whether_done();
  return 0;
}

int FakeBus::discard(const void* urb) {
  const auto found = std::find(waiting_.begin(), waiting_.end(), urb);
  if (found == waiting_.end()) {
    return refused(EINVAL);
  }
  complete(*found, -ENOENT, 0);
  waiting_.erase(found);
  show_whether_done();
  return 0;
}

int FakeBus::ioctl(unsigned long request, void* argument) {
  const std::lock_guard lock{mutex_};
  switch (static_cast<unsigned>(request)) {
    case static_cast<unsigned>(USBDEVFS_CONNECTINFO):
      *static_cast<usbdevfs_connectinfo*>(argument) = {7, 0};
      return 0;
    case static_cast<unsigned>(USBDEVFS_GET_SPEED):
      return 3;
    case static_cast<unsigned>(USBDEVFS_GET_CAPABILITIES):
      *static_cast<std::uint32_t*>(argument) =
          USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
          USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      show_whether_done();
      return 0;
    case static_cast<unsigned>(USBDEVFS_CONTROL): {
      const auto* const control = static_cast<const usbdevfs_ctrltransfer*>(argument);
      constexpr int get_configuration = 8;
      if (control->bRequest != get_configuration) {
        return refused(EPIPE);
      }
      *static_cast<std::uint8_t*>(control->data) = 1;
      return 1;
    }
    case static_cast<unsigned>(USBDEVFS_CLAIMINTERFACE):
    case static_cast<unsigned>(USBDEVFS_RELEASEINTERFACE):
    case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):
    case static_cast<unsigned>(USBDEVFS_RESET):
      return is_gone_ ? refused(ENODEV) : 0;
    case static_cast<unsigned>(USBDEVFS_SUBMITURB):
      return submit(static_cast<usbdevfs_urb*>(argument));
    case static_cast<unsigned>(USBDEVFS_REAPURBNDELAY):
      return reap(static_cast<void**>(argument));
    case static_cast<unsigned>(USBDEVFS_DISCARDURB):
      return discard(argument);
    case static_cast<unsigned>(USBDEVFS_BULK): {
      auto* const bulk = static_cast<usbdevfs_bulktransfer*>(argument);
      if (is_gone_) {
        return refused(ENODEV);
      }
      const auto* const bytes = static_cast<const std::uint8_t*>(bulk->data);
      requests_.emplace_back(bytes, bytes + bulk->len);
      if (plain_bulk_copy_ >= 0 && write(plain_bulk_copy_, bytes, bulk->len) < 0) {
        return refused(EIO);
      }
      return static_cast<int>(bulk->len);
    }
    default:
      return refused(ENOTTY);
  }
}

std::int64_t FakeBus::read(void* to, std::size_t size) {
  const std::lock_guard lock{mutex_};
  const std::size_t count = std::min(size, descriptors_.size() - read_at_);
  std::memcpy(to, descriptors_.data() + read_at_, count);
  read_at_ += count;
  return static_cast<std::int64_t>(count);
}

// Wakes for replies that are due meanwhile, and tells of an unplugged device as the kernel does.
int FakeBus::poll(pollfd* all, unsigned long count, int time_out_ms) {
  const auto end = Clock::now() + std::chrono::milliseconds{time_out_ms < 0 ? 60'000 : time_out_ms};
  while (true) {
    deliver_what_is_due();
    const int slice_ms = Clock::now() < end ? 1 : 0;
    const bool waits_for_late = [&] {
      const std::lock_guard lock{mutex_};
      return !replies_.empty() && !waiting_.empty();
    }();
    const auto ready =
        static_cast<int>(syscall(SYS_poll, all, count, waits_for_late ? slice_ms : time_out_ms));
    if (ready == 0 && waits_for_late && slice_ms > 0) {
      continue;
    }
    const std::lock_guard lock{mutex_};
    for (unsigned long i = 0; is_gone_ && ready > 0 && i < count; ++i) {
      if (all[i].fd == descriptor_ && all[i].revents != 0) {
        all[i].revents = static_cast<short>(all[i].revents | POLLERR | POLLHUP);
      }
    }
    return ready;
  }
}
}  // namespace tapstudy::testing

using tapstudy::testing::FakeBus;

// The shared library of libusb finds these before the C library's.
extern "C" {
int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list arguments;
  va_start(arguments, request);
  void* const argument = va_arg(arguments, void*);
  va_end(arguments);
  FakeBus* const bus = FakeBus::of(descriptor);
  return bus != nullptr ? bus->ioctl(request, argument)
                        : static_cast<int>(syscall(SYS_ioctl, descriptor, request, argument));
}
ssize_t read(int descriptor, void* to, std::size_t size) {
  FakeBus* const bus = FakeBus::of(descriptor);
  return bus != nullptr ? bus->read(to, size) : syscall(SYS_read, descriptor, to, size);
}
int poll(struct pollfd* all, nfds_t count, int time_out_ms) {
  for (nfds_t i = 0; i < count; ++i) {
    if (FakeBus* const bus = FakeBus::of(all[i].fd)) {
      return bus->poll(all, count, time_out_ms);
    }
  }
  return static_cast<int>(syscall(SYS_poll, all, count, time_out_ms));
}
}
