#include <fmt/format.h>

#include <chrono>

#include "device/remote/remote_hand.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/devices/shipped_devices.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
// Of another program to a tick's question.
constexpr std::chrono::milliseconds max_reply{3};

struct RemoteSection final : protocols::DeviceSection {
  std::uint16_t port{};
};

class RemoteDevice final : public SessionDevice {
 public:
  explicit RemoteDevice(std::uint16_t port)
      : lock_{fmt::format("remote device at port {}", port),
              fmt::format("remote: UDP port {} is in use by another session", port)},
        hand_{port, max_reply} {}
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
    });
    return section;
  }
  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    return std::make_unique<RemoteDevice>(
        dynamic_cast<const RemoteSection&>(*request.rig.section).port);
  }
};
}  // namespace

const DeviceKind& remote_device() {
  static const RemoteKind kind;
  return kind;
}
}  // namespace tapstudy::runner
