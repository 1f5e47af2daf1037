#include "device/usb/libusb_pipe.hpp"

#include <fmt/format.h>
#include <libusb.h>
#include <poll.h>
#include <sys/time.h>

#include <algorithm>
#include <array>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr int interface_number = 0;
constexpr std::size_t max_packet_bytes = 512;
constexpr int max_stale_replies = 16;
constexpr Nanoseconds one_wait = 10'000'000;
constexpr Nanoseconds max_wait_to_cancel = 1'000'000'000;
constexpr int looks_after_it = 5;  // the process may have been suspended for so long
constexpr Nanoseconds drain_wait = 1'000'000;
constexpr std::size_t max_waited_for = 8;

UsbOutcome outcome_of(int error) noexcept {
  switch (error) {
    case LIBUSB_SUCCESS:
      return UsbOutcome::ok;
    case LIBUSB_ERROR_NO_DEVICE:
      return UsbOutcome::gone;
    case LIBUSB_ERROR_PIPE:
      return UsbOutcome::stalled;
    case LIBUSB_ERROR_OVERFLOW:
      return UsbOutcome::short_packet;
    default:
      return UsbOutcome::failed;
  }
}

UsbOutcome outcome_of(const libusb_transfer& transfer) noexcept {
  switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return transfer.actual_length == transfer.length ? UsbOutcome::ok : UsbOutcome::short_packet;
    case LIBUSB_TRANSFER_CANCELLED:
      return UsbOutcome::timed_out;
    case LIBUSB_TRANSFER_STALL:
      return UsbOutcome::stalled;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return UsbOutcome::gone;
    case LIBUSB_TRANSFER_OVERFLOW:
      return UsbOutcome::short_packet;
    default:
      return UsbOutcome::failed;
  }
}

DeviceError refusal(const char* what, int error) {
  return DeviceError{fmt::format("USB: {}: {}", what, libusb_strerror(error))};
}
}  // namespace

// What becomes of transfers, and the descriptors at which it shows. libusb itself counts time in
// milliseconds, too coarsely for a tick; it is only asked what has happened.
class Events {
 public:
  Events(libusb_context* context, PipeClock clock) : context_{context}, now_{clock} {
    const libusb_pollfd** const all = libusb_get_pollfds(context);
    for (std::size_t i = 0; all != nullptr && all[i] != nullptr; ++i) {
      if (count_ == max_waited_for) {
        throw DeviceError{"USB: libusb waits at more descriptors than expected"};
      }
      waited_for_[count_++] = {all[i]->fd, all[i]->events, 0};
    }
    libusb_free_pollfds(all);
  }
  Nanoseconds now() const noexcept { return now_(); }
  // Whether the flag is set by the deadline.
  bool wait_for(int& has_ended, Nanoseconds deadline) noexcept {
    while (true) {
      timeval at_once{};
      libusb_handle_events_timeout_completed(context_, &at_once, &has_ended);
      const Nanoseconds left = deadline - now();
      if (has_ended != 0 || left <= 0) {
        return has_ended != 0;
      }
      const timespec patience{0, static_cast<long>(std::min(left, one_wait))};
      ppoll(waited_for_.data(), count_, &patience, nullptr);
    }
  }

 private:
  libusb_context* context_;
  PipeClock now_;
  std::array<pollfd, max_waited_for> waited_for_{};
  std::size_t count_{0};
};

// A reusable transfer. It has the linkage of the pipe's members, as have Events.
class Transfer {
 public:
  Transfer() : transfer_{libusb_alloc_transfer(0)} {
    if (transfer_ == nullptr) {
      throw DeviceError{"USB: not enough memory for a transfer"};
    }
  }
  ~Transfer() {
    if (!is_under_way()) {  // else the kernel may still write to it: leak it
      libusb_free_transfer(transfer_);
    }
  }
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;
  Transfer(Transfer&&) = delete;
  Transfer& operator=(Transfer&&) = delete;

  UsbOutcome submit(libusb_device_handle* device, std::uint8_t endpoint, std::uint8_t* data,
                    std::size_t size) noexcept {
    constexpr unsigned no_time_out = 0;
    libusb_fill_bulk_transfer(transfer_, device, endpoint, data, static_cast<int>(size), ended,
                              &has_ended_, no_time_out);
    has_ended_ = 0;
    const UsbOutcome outcome = outcome_of(libusb_submit_transfer(transfer_));
    if (outcome != UsbOutcome::ok) {
      has_ended_ = 1;
    }
    return outcome;
  }
  bool is_under_way() const noexcept { return has_ended_ == 0; }
  void cancel() noexcept {
    if (is_under_way()) {
      libusb_cancel_transfer(transfer_);
    }
  }
  // After the deadline it is cancelled. Terminates even if the kernel never returns the transfer.
  UsbOutcome wait(Events& events, Nanoseconds deadline) noexcept {
    if (!events.wait_for(has_ended_, deadline)) {
      cancel();
      const Nanoseconds give_up = events.now() + max_wait_to_cancel;
      for (int looks = looks_after_it; is_under_way() && looks > 0; --looks) {
        events.wait_for(has_ended_, give_up);
      }
    }
    return is_under_way() ? UsbOutcome::failed : outcome_of(*transfer_);
  }

 private:
  static void LIBUSB_CALL ended(libusb_transfer* transfer) {
    *static_cast<int*>(transfer->user_data) = 1;
  }
  libusb_transfer* transfer_;
  int has_ended_{1};
};

// They have the linkage of the pipe's members, too.
struct ExitLibrary {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ExitLibrary>;
struct CloseDevice {
  void operator()(libusb_device_handle* device) const { libusb_close(device); }
};
using OpenDevice = std::unique_ptr<libusb_device_handle, CloseDevice>;

namespace {
Context started_library() {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != LIBUSB_SUCCESS) {
    throw refusal("the library cannot be started", error);
  }
  return Context{context};
}

OpenDevice opened(libusb_context* context, const UsbNode& node) {
  libusb_device_handle* device = nullptr;
  const int error = libusb_wrap_sys_device(context, node.descriptor(), &device);
  if (error != LIBUSB_SUCCESS) {
    throw refusal("the device cannot be opened", error);
  }
  return OpenDevice{device};
}

void claim(libusb_device_handle* device) {
  const int error = libusb_claim_interface(device, interface_number);
  if (error == LIBUSB_SUCCESS) {
    return;
  }
  constexpr const char* what = "the device cannot be claimed (does another program use it?)";
  if (error == LIBUSB_ERROR_BUSY) {
    throw ClaimedByAnother{refusal(what, error).what()};
  }
  throw refusal(what, error);
}
}  // namespace

struct LibusbPipe::Libusb {
  Context owned_context;
  OpenDevice owned_device;
  libusb_device_handle* device;
  Events events;
  BulkEndpoints endpoints;
  Nanoseconds time_out;
  Transfer request;
  Transfer reply;
  std::array<std::uint8_t, max_packet_bytes> request_bytes{};
  std::array<std::uint8_t, max_packet_bytes> reply_bytes{};

  Libusb(const UsbNode& node, const BulkEndpoints& both, std::chrono::microseconds max_reply,
         PipeClock now)
      : owned_context{started_library()},
        owned_device{opened(owned_context.get(), node)},
        device{owned_device.get()},
        events{owned_context.get(), now},
        endpoints{both},
        time_out{std::chrono::nanoseconds{max_reply}.count()} {
    claim(device);
  }
  ~Libusb() {
    request.cancel();
    reply.cancel();
    static_cast<void>(request.wait(events, events.now()));
    static_cast<void>(reply.wait(events, events.now()));
    libusb_release_interface(device, interface_number);
  }
  Libusb(const Libusb&) = delete;
  Libusb& operator=(const Libusb&) = delete;
  Libusb(Libusb&&) = delete;
  Libusb& operator=(Libusb&&) = delete;

  bool is_idle() const noexcept { return !request.is_under_way() && !reply.is_under_way(); }
  UsbOutcome submit_request(std::span<const std::uint8_t> out) noexcept {
    std::ranges::copy(out, request_bytes.begin());
    return request.submit(device, endpoints.out, request_bytes.data(), out.size());
  }
  UsbOutcome submit_reply(std::size_t size) noexcept {
    return reply.submit(device, endpoints.in, reply_bytes.data(), size);
  }
  Nanoseconds deadline() const noexcept { return events.now() + time_out; }
};

Nanoseconds monotonic_now() noexcept {
  return MonotonicClock{}.now();
}

LibusbPipe::LibusbPipe(const UsbNode& node, const BulkEndpoints& endpoints,
                       std::chrono::microseconds max_reply, PipeClock now)
    : libusb_{std::make_unique<Libusb>(node, endpoints, max_reply, now)} {}

LibusbPipe::~LibusbPipe() = default;

UsbOutcome LibusbPipe::send(std::span<const std::uint8_t> out) noexcept {
  if (libusb_->request.is_under_way() || out.size() > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  const UsbOutcome outcome = libusb_->submit_request(out);
  return outcome == UsbOutcome::ok ? libusb_->request.wait(libusb_->events, libusb_->deadline())
                                   : outcome;
}

UsbOutcome LibusbPipe::exchange(std::span<const std::uint8_t> out,
                                std::span<std::uint8_t> in) noexcept {
  if (!libusb_->is_idle() || std::max(out.size(), in.size()) > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  const Nanoseconds deadline = libusb_->deadline();
  if (const UsbOutcome outcome = libusb_->submit_reply(in.size()); outcome != UsbOutcome::ok) {
    return outcome;
  }
  const UsbOutcome submitted = libusb_->submit_request(out);
  if (submitted != UsbOutcome::ok) {
    libusb_->reply.cancel();
  }
  const UsbOutcome sent =
      submitted == UsbOutcome::ok ? libusb_->request.wait(libusb_->events, deadline) : submitted;
  if (sent != UsbOutcome::ok) {
    libusb_->reply.cancel();
  }
  const UsbOutcome received = libusb_->reply.wait(libusb_->events, deadline);
  std::ranges::copy(std::span{libusb_->reply_bytes}.first(in.size()), in.begin());
  return sent != UsbOutcome::ok ? sent : received;
}

UsbOutcome LibusbPipe::receive(std::span<std::uint8_t> in) noexcept {
  if (!libusb_->is_idle() || in.size() > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  if (const UsbOutcome outcome = libusb_->submit_reply(in.size()); outcome != UsbOutcome::ok) {
    return outcome;
  }
  const UsbOutcome received = libusb_->reply.wait(libusb_->events, libusb_->deadline());
  std::ranges::copy(std::span{libusb_->reply_bytes}.first(in.size()), in.begin());
  return received;
}

void LibusbPipe::clear_halt() noexcept {
  libusb_clear_halt(libusb_->device, libusb_->endpoints.in);
  libusb_clear_halt(libusb_->device, libusb_->endpoints.out);
}

void LibusbPipe::drain() noexcept {
  for (int i = 0; i < max_stale_replies && libusb_->is_idle(); ++i) {
    if (libusb_->submit_reply(max_packet_bytes) != UsbOutcome::ok ||
        libusb_->reply.wait(libusb_->events, libusb_->events.now() + drain_wait) ==
            UsbOutcome::timed_out) {
      return;
    }
  }
}
}  // namespace tapstudy::device
