#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "device/remote/remote_hand.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/devices/shipped_devices.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
struct RemoteSection final : protocols::DeviceSection {
  std::uint16_t port{};
  double max_reply_s{0.003};  // of the other program to a tick's question
};

class RemoteDevice final : public SessionDevice {
 public:
  explicit RemoteDevice(const RemoteSection& section)
      : lock_{fmt::format("remote device at port {}", section.port),
              fmt::format("remote: UDP port {} is in use by another session", section.port)},
        hand_{section.port, std::chrono::microseconds{std::llround(1e6 * section.max_reply_s)}} {}
  device::Device& device() override { return hand_; }
  void get_ready() override {}

 private:
  SessionLock lock_;
  device::RemoteHand hand_;
};

class RemoteKind final : public DeviceKind {
 public:
  std::string_view name() const override { return "remote"; }
  bool has_hardware() const override { return true; }
  std::shared_ptr<const protocols::DeviceSection> read_section(
      protocols::MapReader& top, const protocols::RigText& /*rig*/) const override {
    auto section = std::make_shared<RemoteSection>();
    top.map("remote", protocols::MapReader::Presence::required, [&](protocols::MapReader& reader) {
      section->port = static_cast<std::uint16_t>(reader.integer("port", 1024, 65535));
      section->max_reply_s = reader.number("max_reply_s", {0.001, 0.1}, section->max_reply_s);
    });
    return section;
  }
  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    return std::make_unique<RemoteDevice>(dynamic_cast<const RemoteSection&>(*request.rig.section));
  }
};
}  // namespace

const DeviceKind& remote_device() {
  static const RemoteKind kind;
  return kind;
}
}  // namespace tapstudy::runner
