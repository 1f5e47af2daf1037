#include "device/usb/libusb_pipe.hpp"

#include <fmt/format.h>
#include <libusb.h>
#include <sys/time.h>

#include <algorithm>
#include <array>

#include "device/device.hpp"
namespace tapstudy::device {
namespace {
constexpr int interface_number = 0;
constexpr std::size_t max_packet_bytes = 512;
constexpr int max_stale_replies = 16;
constexpr timeval one_wait{0, 10'000};
constexpr std::chrono::seconds max_wait{1};
constexpr int looks_after_it = 5;  // the process may have been suspended for so long

UsbOutcome outcome_of(int error) noexcept {
  switch (error) {
    case LIBUSB_SUCCESS:
      return UsbOutcome::ok;
    case LIBUSB_ERROR_TIMEOUT:
      return UsbOutcome::timed_out;
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
    case LIBUSB_TRANSFER_TIMED_OUT:
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

// A reusable transfer with its own buffer. It has the linkage of the pipe's members.
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
                    std::size_t size, unsigned time_out_ms) noexcept {
    libusb_fill_bulk_transfer(transfer_, device, endpoint, data, static_cast<int>(size), ended,
                              &has_ended_, time_out_ms);
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
  // Every transfer has its own timeout, so this terminates, even if the kernel never returns the
  // transfer.
  UsbOutcome wait(libusb_context* context) noexcept {
    const auto give_up = std::chrono::steady_clock::now() + max_wait;
    int looks = looks_after_it;
    while (is_under_way() && (std::chrono::steady_clock::now() < give_up || --looks >= 0)) {
      timeval patience = one_wait;
      libusb_handle_events_timeout_completed(context, &patience, &has_ended_);
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
  libusb_context* context;
  libusb_device_handle* device;
  BulkEndpoints endpoints;
  unsigned time_out_ms;
  Transfer request;
  Transfer reply;
  std::array<std::uint8_t, max_packet_bytes> request_bytes{};
  std::array<std::uint8_t, max_packet_bytes> reply_bytes{};

  Libusb(const UsbNode& node, const BulkEndpoints& both, std::chrono::milliseconds time_out)
      : owned_context{started_library()},
        owned_device{opened(owned_context.get(), node)},
        context{owned_context.get()},
        device{owned_device.get()},
        endpoints{both},
        time_out_ms{static_cast<unsigned>(time_out.count())} {
    claim(device);
  }
  ~Libusb() {
    request.cancel();
    reply.cancel();
    static_cast<void>(request.wait(context));
    static_cast<void>(reply.wait(context));
    libusb_release_interface(device, interface_number);
  }
  Libusb(const Libusb&) = delete;
  Libusb& operator=(const Libusb&) = delete;
  Libusb(Libusb&&) = delete;
  Libusb& operator=(Libusb&&) = delete;

  bool is_idle() const noexcept { return !request.is_under_way() && !reply.is_under_way(); }
  UsbOutcome submit_request(std::span<const std::uint8_t> out) noexcept {
    std::ranges::copy(out, request_bytes.begin());
    return request.submit(device, endpoints.out, request_bytes.data(), out.size(), time_out_ms);
  }
  UsbOutcome submit_reply(std::size_t size, unsigned patience_ms) noexcept {
    return reply.submit(device, endpoints.in, reply_bytes.data(), size, patience_ms);
  }
};

LibusbPipe::LibusbPipe(const UsbNode& node, const BulkEndpoints& endpoints,
                       std::chrono::milliseconds time_out)
    : libusb_{std::make_unique<Libusb>(node, endpoints, time_out)} {}

LibusbPipe::~LibusbPipe() = default;

UsbOutcome LibusbPipe::send(std::span<const std::uint8_t> out) noexcept {
  if (libusb_->request.is_under_way() || out.size() > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  const UsbOutcome outcome = libusb_->submit_request(out);
  return outcome == UsbOutcome::ok ? libusb_->request.wait(libusb_->context) : outcome;
}

UsbOutcome LibusbPipe::exchange(std::span<const std::uint8_t> out,
                                std::span<std::uint8_t> in) noexcept {
  if (!libusb_->is_idle() || std::max(out.size(), in.size()) > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  if (const UsbOutcome outcome = libusb_->submit_reply(in.size(), libusb_->time_out_ms);
      outcome != UsbOutcome::ok) {
    return outcome;
  }
  const UsbOutcome submitted = libusb_->submit_request(out);
  if (submitted != UsbOutcome::ok) {
    libusb_->reply.cancel();
  }
  const UsbOutcome sent =
      submitted == UsbOutcome::ok ? libusb_->request.wait(libusb_->context) : submitted;
  if (sent != UsbOutcome::ok) {
    libusb_->reply.cancel();
  }
  const UsbOutcome received = libusb_->reply.wait(libusb_->context);
  std::ranges::copy(std::span{libusb_->reply_bytes}.first(in.size()), in.begin());
  return sent != UsbOutcome::ok ? sent : received;
}

UsbOutcome LibusbPipe::receive(std::span<std::uint8_t> in) noexcept {
  if (!libusb_->is_idle() || in.size() > max_packet_bytes) {
    return UsbOutcome::failed;
  }
  if (const UsbOutcome outcome = libusb_->submit_reply(in.size(), libusb_->time_out_ms);
      outcome != UsbOutcome::ok) {
    return outcome;
  }
  const UsbOutcome received = libusb_->reply.wait(libusb_->context);
  std::ranges::copy(std::span{libusb_->reply_bytes}.first(in.size()), in.begin());
  return received;
}

void LibusbPipe::clear_halt() noexcept {
  libusb_clear_halt(libusb_->device, libusb_->endpoints.in);
  libusb_clear_halt(libusb_->device, libusb_->endpoints.out);
}

void LibusbPipe::drain() noexcept {
  for (int i = 0; i < max_stale_replies && libusb_->is_idle(); ++i) {
    if (libusb_->submit_reply(max_packet_bytes, 1) != UsbOutcome::ok ||
        libusb_->reply.wait(libusb_->context) == UsbOutcome::timed_out) {
      return;
    }
  }
}
}  // namespace tapstudy::device
