#include "lab/mocked_board.hpp"

#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/uio.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "device/spidar/board.hpp"
namespace tapstudy::lab {
using testing::Bytes;
namespace {
usbdevfs_urb* urb_of(const ClientData& data) {
  return reinterpret_cast<usbdevfs_urb*>(data->data);
}

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += fmt::format("{:02X}", byte);
  }
  return text;
}

// What the argument points to, as much of it as the request's number says.
ClientData pointed_to(UMockdevIoctlClient* client) {
  const auto size = _IOC_SIZE(umockdev_ioctl_client_get_request(client));
  return ClientData{size == 0 ? nullptr
                              : umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client),
                                                            0, size, nullptr)};
}

// Makes the pointer at `offset` one to a copy in this process, which `data` keeps.
void fetch(const ClientData& data, std::size_t offset, std::size_t size) {
  const ClientData copy{umockdev_ioctl_data_resolve(data.get(), offset, size, nullptr)};
}

std::uintptr_t argument_of(UMockdevIoctlClient* client) {
  std::uintptr_t argument{};
  std::memcpy(&argument, umockdev_ioctl_client_get_arg(client)->data, sizeof argument);
  return argument;
}

void copy_from(pid_t process, std::uintptr_t address, void* to, std::size_t size) {
  const iovec here{to, size};
  const iovec there{reinterpret_cast<void*>(address), size};
  if (process_vm_readv(process, &here, 1, &there, 1, 0) != static_cast<ssize_t>(size)) {
    std::perror("the memory of the guardian");
    std::abort();
  }
}

// Gone, if the guardian is.
void copy_to(pid_t process, std::uintptr_t address, void* from, std::size_t size) {
  const iovec here{from, size};
  const iovec there{reinterpret_cast<void*>(address), size};
  static_cast<void>(process_vm_writev(process, &here, 1, &there, 1, 0));
}

template <class Value>
Value value_at(pid_t process, std::uintptr_t address) {
  Value value{};
  copy_from(process, address, &value, sizeof value);
  return value;
}

void complete_with(UMockdevIoctlClient* client, int result) {
  umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? -result : 0);
}
}  // namespace

MockedBoard::MockedBoard(UMockdevTestbed* bed, int address, AfterExchange after)
    : bed_{bed},
      base_{umockdev_ioctl_base_new()},
      address_{address},
      after_{std::move(after)},
      usbfs_{*this, static_cast<unsigned>(address)} {
  g_signal_connect(base_, "handle-ioctl", G_CALLBACK(handle), this);
}

MockedBoard::~MockedBoard() {
  g_object_unref(base_);
}

std::string MockedBoard::name() const {
  return fmt::format("/sys/devices/usb1/1-{}", address_);
}

std::string MockedBoard::node() const {
  return fmt::format("/dev/bus/usb/001/{:03}", address_);
}

void MockedBoard::plug_in() {
  umockdev_testbed_attach_ioctl(bed_, node().c_str(), base_, nullptr);
  const std::string description = fmt::format(
      "P: /devices/usb1/1-{0}\nN: bus/usb/001/{0:03}={1}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
      "E: BUSNUM=001\nE: DEVNUM={0:03}\nE: DEVNAME=/dev/bus/usb/001/{0:03}\nA: busnum=1\\n\n"
      "A: devnum={0}\\n\nA: bConfigurationValue=1\\n\nA: speed=480\\n\nH: descriptors={1}\n",
      address_, hex(testing::descriptors_of(device::cyverse_vendor, device::sh4_product)));
  umockdev_testbed_add_from_string(bed_, description.c_str(), nullptr);
}

void MockedBoard::unplug() {
  {
    const std::lock_guard lock{mutex_};
    usbfs_.unplug();
  }
  umockdev_testbed_uevent(bed_, name().c_str(), "remove");
  umockdev_testbed_remove_device(bed_, name().c_str());
}

void MockedBoard::halt() {
  const std::lock_guard lock{mutex_};
  usbfs_.halt_out(1);
}

void MockedBoard::hang() {
  const std::lock_guard lock{mutex_};
  usbfs_.persist_in(testing::FakeUsbfs::Trouble::out_lost);
}

void MockedBoard::stop_taking() {
  const std::lock_guard lock{mutex_};
  usbfs_.persist_in(testing::FakeUsbfs::Trouble::out_nak);
}

void MockedBoard::take_again() {
  const std::lock_guard lock{mutex_};
  usbfs_.persist_in(testing::FakeUsbfs::Trouble::none);
}

MockedBoard::Log MockedBoard::log() {
  const std::lock_guard lock{mutex_};
  return log_;
}

void MockedBoard::with_hardware(const std::function<void(testing::SimulatedSpidar&)>& act) {
  const std::lock_guard lock{mutex_};
  act(hardware_);
}

gboolean MockedBoard::handle(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                             gpointer self) {
  auto& board = *static_cast<MockedBoard*>(self);
  int ended = 0;
  {
    const std::lock_guard lock{board.mutex_};
    if (!board.answer(client)) {
      return FALSE;
    }
    ended = std::exchange(board.exchange_that_ended_, 0);
  }
  if (ended > 0 && board.after_) {
    board.after_(ended);
  }
  return TRUE;
}

bool MockedBoard::answer(UMockdevIoctlClient* client) {
  switch (static_cast<unsigned>(umockdev_ioctl_client_get_request(client))) {
    case static_cast<unsigned>(USBDEVFS_SUBMITURB):
      submit(client);
      return true;
    case static_cast<unsigned>(USBDEVFS_REAPURBNDELAY):
      reap(client);
      return true;
    case static_cast<unsigned>(USBDEVFS_DISCARDURB):
      discard(client);
      return true;
    case static_cast<unsigned>(USBDEVFS_BULK):
      bulk(client);
      return true;
    case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):  // of the heir's, maybe: see bulk()
      complete_with(client, usbfs_.ioctl(USBDEVFS_CLEAR_HALT, nullptr));
      return true;
    default:
      return pass_on(client);
  }
}

bool MockedBoard::pass_on(UMockdevIoctlClient* client) {
  const gulong request = umockdev_ioctl_client_get_request(client);
  const ClientData data = pointed_to(client);
  if (request == USBDEVFS_CONTROL) {
    fetch(data, offsetof(usbdevfs_ctrltransfer, data), 1);
  }
  const int result = usbfs_.ioctl(request, data ? data->data : nullptr);
  if (result == -ENOTTY) {
    return false;  // the test bed may know it
  }
  complete_with(client, result);
  return true;
}

Bytes MockedBoard::answer(std::span<const std::uint8_t> request) {
  ++log_.requests;
  log_.dac_counts = 0;
  for (std::size_t i = 2; i + 1 < std::min<std::size_t>(request.size(), 18); i += 2) {
    log_.dac_counts = std::max(log_.dac_counts, request[i] | request[i + 1] << 8);
  }
  log_.max_dac_counts = std::max(log_.max_dac_counts, log_.dac_counts);
  log_.requests_without_force_at_the_end =
      log_.dac_counts != 0 ? 0 : log_.requests_without_force_at_the_end + 1;
  return hardware_.answer(request);
}

void MockedBoard::submit(UMockdevIoctlClient* client) {
  ClientData data = pointed_to(client);
  usbdevfs_urb* const urb = urb_of(data);
  fetch(data, offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(urb->buffer_length));
  const int result = usbfs_.ioctl(USBDEVFS_SUBMITURB, urb);
  if (result == 0) {
    under_way_.push_back(std::move(data));
  }
  complete_with(client, result);
}

void MockedBoard::reap(UMockdevIoctlClient* client) {
  void* urb = nullptr;
  if (const int result = usbfs_.ioctl(USBDEVFS_REAPURBNDELAY, &urb); result < 0) {
    complete_with(client, result);
    // nothing is under way: the program has its reply and turns to its tick
    exchange_that_ended_ = usbfs_.is_waited_for() ? 0 : log_.requests;
    return;
  }
  const auto reaped = std::ranges::find(under_way_, urb, urb_of);
  const ClientData pointer = pointed_to(client);
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, reaped->get());
  complete_with(client, 0);
  under_way_.erase(reaped);
}

// The program knows a transfer by its address there.
void MockedBoard::discard(UMockdevIoctlClient* client) {
  const auto found = std::ranges::find(under_way_, argument_of(client),
                                       [](const ClientData& data) { return data->client_addr; });
  complete_with(client, usbfs_.ioctl(USBDEVFS_DISCARDURB,
                                     found == under_way_.end() ? nullptr : urb_of(*found)));
}

void MockedBoard::bulk(UMockdevIoctlClient* client) {
  if (usbfs_.is_gone()) {
    complete_with(client, -ENODEV);
    return;
  }
  // The test bed would look into the memory of the process that opened the node, not of its heir.
  auto transfer = value_at<usbdevfs_bulktransfer>(heir_, argument_of(client));
  Bytes bytes(transfer.len);
  const auto there = reinterpret_cast<std::uintptr_t>(transfer.data);
  copy_from(heir_, there, bytes.data(), bytes.size());
  transfer.data = bytes.data();
  const int result = usbfs_.ioctl(USBDEVFS_BULK, &transfer);
  if (result > 0 && transfer.ep == testing::in_endpoint) {
    copy_to(heir_, there, bytes.data(), static_cast<std::size_t>(result));
  }
  complete_with(client, result);
}
}  // namespace tapstudy::lab
