#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "device/remote/remote_hand.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::chrono::milliseconds tried_silence{150};

struct RemoteSection final : protocols::DeviceSection {
  std::uint16_t port{};
  double max_reply_s{0.003};  // of the other program to a tick's question
  int delay_ticks{1};         // of its force
  double max_reply_time_s() const override { return max_reply_s; }
};

class RemoteDevice final : public SessionDevice {
 public:
  explicit RemoteDevice(const RemoteSection& section)
      : lock_{fmt::format("remote device at port {}", section.port),
              fmt::format("remote: UDP port {} is in use by another session", section.port)},
        hand_{section.port, std::chrono::microseconds{std::llround(1e6 * section.max_reply_s)}} {}
  device::Device& device() override { return hand_; }
  device::RemoteHand& hand() { return hand_; }
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
    top.map({"remote", "a device driven by another program on this machine"},
            protocols::MapReader::Presence::required, [&](protocols::MapReader& reader) {
              section->port = static_cast<std::uint16_t>(
                  reader.integer({"port", "UDP port on the loopback interface"}, 1024, 65535));
              section->max_reply_s = read_max_reply_s(reader, section->max_reply_s);
              section->delay_ticks =
                  reader.integer({"delay_ticks",
                                  "ticks between the request of a force and its action, for the "
                                  "stability bound that `check` prints"},
                                 0, 10, section->delay_ticks);
            });
    return section;
  }
  int delay_ticks(const protocols::Rig& rig) const override {
    return dynamic_cast<const RemoteSection&>(*rig.section).delay_ticks;
  }
  std::function<void()> zero_force_exchange(const protocols::Rig& rig) const override {
    const auto opened =
        std::make_shared<RemoteDevice>(dynamic_cast<const RemoteSection&>(*rig.section));
    return [opened] {
      core::HandState ignored;
      core::TickFault fault = opened->hand().read(ignored, 0.0);
      fault = fault == core::TickFault::none ? opened->hand().write(core::Vec3::Zero()) : fault;
      if (fault != core::TickFault::none) {
        throw device::DeviceError{fmt::format("remote: {}", to_text(fault))};
      }
    };
  }
  std::string tried_release(const protocols::Rig& rig) const override {
    RemoteDevice opened{dynamic_cast<const RemoteSection&>(*rig.section)};
    using Release = device::RemoteHand::Release;
    switch (opened.hand().release_after(tried_silence)) {
      case Release::held:
        throw device::DeviceError{fmt::format(
            "remote: the other program did not release the force after {} ms without requests",
            tried_silence.count())};
      case Release::always_reported:
        throw device::DeviceError{
            "remote: the other program reports a released force in every reply: it must report it "
            "only after a silence (device/remote/packets.hpp)"};
      case Release::not_reported:
        break;
      case Release::released:
        return fmt::format(
            "the other program reports that it released the force after {} ms "
            "without requests",
            tried_silence.count());
    }
    return "the other program does not report this, or did not reply (version 1 cannot report "
           "it): test it manually";
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
