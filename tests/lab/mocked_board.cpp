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
usbdevfs_urb* urb_of(UMockdevIoctlData* data) {
  return reinterpret_cast<usbdevfs_urb*>(data->data);
}

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += fmt::format("{:02X}", byte);
  }
  return text;
}

constexpr glong high_speed = 3;

// The answer of an ioctl that asks for a value.
template <class Value>
void tell(UMockdevIoctlClient* client, const Value& value) {
  UMockdevIoctlData* const data =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(Value), nullptr);
  std::memcpy(data->data, &value, sizeof(Value));
  umockdev_ioctl_client_complete(client, 0, 0);
  g_object_unref(data);
}

// GET_CONFIGURATION is the one control request there is.
void tell_configuration(UMockdevIoctlClient* client) {
  UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(
      umockdev_ioctl_client_get_arg(client), 0, sizeof(usbdevfs_ctrltransfer), nullptr);
  UMockdevIoctlData* const byte =
      umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_ctrltransfer, data), 1, nullptr);
  byte->data[0] = 1;
  umockdev_ioctl_client_complete(client, 1, 0);
  g_object_unref(byte);
  g_object_unref(data);
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

template <class Value>
Value value_at(pid_t process, std::uintptr_t address) {
  Value value{};
  copy_from(process, address, &value, sizeof value);
  return value;
}

void complete_with(UMockdevIoctlClient* client, int error) {
  umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
}
}  // namespace

MockedBoard::MockedBoard(UMockdevTestbed* bed, int address, AfterExchange after)
    : bed_{bed}, base_{umockdev_ioctl_base_new()}, address_{address}, after_{std::move(after)} {
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
    is_gone_ = true;
    end_waiting(-ESHUTDOWN);
  }
  umockdev_testbed_uevent(bed_, name().c_str(), "remove");
  umockdev_testbed_remove_device(bed_, name().c_str());
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
    case static_cast<unsigned>(USBDEVFS_CONNECTINFO):
      tell(client, usbdevfs_connectinfo{static_cast<unsigned>(address_), 0});
      return true;
    case static_cast<unsigned>(USBDEVFS_GET_SPEED):
      umockdev_ioctl_client_complete(client, high_speed, 0);
      return true;
    case static_cast<unsigned>(USBDEVFS_GET_CAPABILITIES):
      tell(client, USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                       USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT);
      return true;
    case static_cast<unsigned>(USBDEVFS_CONTROL):
      tell_configuration(client);
      return true;
    case static_cast<unsigned>(USBDEVFS_GETDRIVER):
      complete_with(client, ENODATA);
      return true;
    case static_cast<unsigned>(USBDEVFS_CLAIMINTERFACE):
    case static_cast<unsigned>(USBDEVFS_RELEASEINTERFACE):
    case static_cast<unsigned>(USBDEVFS_CLEAR_HALT):
    case static_cast<unsigned>(USBDEVFS_SETINTERFACE):
    case static_cast<unsigned>(USBDEVFS_RESET):
      complete_with(client, is_gone_ ? ENODEV : 0);
      return true;
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
    default:
      return false;
  }
}

void MockedBoard::take_request(const Bytes& request) {
  ++log_.requests;
  bool has_force = false;
  for (std::size_t i = 2; i + 1 < std::min<std::size_t>(request.size(), 18); i += 2) {
    const int dac_counts = request[i] | request[i + 1] << 8;
    log_.max_dac_counts = std::max(log_.max_dac_counts, dac_counts);
    has_force = has_force || dac_counts != 0;
  }
  log_.requests_without_force_at_the_end =
      has_force ? 0 : log_.requests_without_force_at_the_end + 1;
  Bytes reply = hardware_.answer(request);
  if (!reply.empty() && !is_silent_) {
    replies_.push_back(std::move(reply));
  }
}

void MockedBoard::submit(UMockdevIoctlClient* client) {
  if (is_gone_) {
    complete_with(client, ENODEV);
    return;
  }
  UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client),
                                                              0, sizeof(usbdevfs_urb), nullptr);
  usbdevfs_urb* const urb = urb_of(data);
  UMockdevIoctlData* const buffer = umockdev_ioctl_data_resolve(
      data, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(urb->buffer_length), nullptr);
  if (urb->endpoint == testing::out_endpoint) {
    take_request({buffer->data, buffer->data + urb->buffer_length});
    urb->actual_length = urb->buffer_length;
    urb->status = 0;
    done_.push_back(data);
  } else {
    waiting_.push_back(data);
  }
  g_object_unref(buffer);
  deliver();
  complete_with(client, 0);
}

void MockedBoard::deliver() {
  while (!waiting_.empty() && !replies_.empty()) {
    UMockdevIoctlData* const data = waiting_.front();
    usbdevfs_urb* const urb = urb_of(data);
    UMockdevIoctlData* const buffer = umockdev_ioctl_data_resolve(
        data, offsetof(usbdevfs_urb, buffer), static_cast<gsize>(urb->buffer_length), nullptr);
    const auto length =
        std::min(static_cast<std::size_t>(urb->buffer_length), replies_.front().size());
    std::memcpy(buffer->data, replies_.front().data(), length);
    g_object_unref(buffer);
    urb->actual_length = static_cast<int>(length);
    urb->status = 0;
    done_.push_back(data);
    waiting_.pop_front();
    replies_.pop_front();
  }
}

void MockedBoard::end_waiting(int status) {
  while (!waiting_.empty()) {
    urb_of(waiting_.front())->status = status;
    urb_of(waiting_.front())->actual_length = 0;
    done_.push_back(waiting_.front());
    waiting_.pop_front();
  }
}

void MockedBoard::reap(UMockdevIoctlClient* client) {
  if (done_.empty()) {
    complete_with(client, is_gone_ ? ENODEV : EAGAIN);
    // nothing is under way: the program has its reply and turns to its tick
    exchange_that_ended_ = waiting_.empty() ? log_.requests : 0;
    return;
  }
  UMockdevIoctlData* const pointer =
      umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(void*), nullptr);
  umockdev_ioctl_data_set_ptr(pointer, 0, done_.front());
  done_.pop_front();
  complete_with(client, 0);
  g_object_unref(pointer);
}

void MockedBoard::discard(UMockdevIoctlClient* client) {
  const std::uintptr_t address = argument_of(client);
  const auto found = std::ranges::find_if(
      waiting_, [&](const UMockdevIoctlData* data) { return data->client_addr == address; });
  if (found == waiting_.end()) {
    complete_with(client, EINVAL);
    return;
  }
  urb_of(*found)->status = -ENOENT;
  urb_of(*found)->actual_length = 0;
  done_.push_back(*found);
  waiting_.erase(found);
  complete_with(client, 0);
}

void MockedBoard::bulk(UMockdevIoctlClient* client) {
  if (is_gone_) {
    complete_with(client, ENODEV);
    return;
  }
  // The test bed would look into the memory of the process that opened the node, not of its heir.
  const auto transfer = value_at<usbdevfs_bulktransfer>(heir_, argument_of(client));
  Bytes bytes(transfer.len);
  copy_from(heir_, reinterpret_cast<std::uintptr_t>(transfer.data), bytes.data(), bytes.size());
  take_request(bytes);
  replies_.clear();
  umockdev_ioctl_client_complete(client, static_cast<glong>(bytes.size()), 0);
}
}  // namespace tapstudy::lab
