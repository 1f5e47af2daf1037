#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "device/loop/tick_clock.hpp"
#include "device/remote/remote_hand.hpp"
#include "protocols/yaml/yaml_reader.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/stimuli/stimulus_family.hpp"
#include "runner/terminal/logging.hpp"
#include "runner/terminal/session_lock.hpp"
namespace tapstudy::runner {
namespace {
constexpr std::chrono::milliseconds tried_silence{
    static_cast<int>(1e3 * device::wire::max_release_s + 0.5)};

struct RemoteSection final : protocols::DeviceSection {
  std::uint16_t port{};
  double max_reply_s{0.003};  // of the other program to a tick's question
  double max_sample_age_s{device::RemoteLimits{}.max_sample_age_s};
  std::optional<double> force_delay_s;   // from request to action
  std::string accepted_without_release;  // who answers for it, and why; empty: nobody does
  double max_reply_time_s() const override { return max_reply_s; }
};

class RemoteDevice final : public SessionDevice {
 public:
  explicit RemoteDevice(const RemoteSection& section)
      : lock_{fmt::format("remote device at port {}", section.port),
              fmt::format("remote: UDP port {} is in use by another session", section.port)},
        hand_{section.port,
              {std::chrono::microseconds{std::llround(1e6 * section.max_reply_s)},
               section.max_sample_age_s}} {}
  device::Device& device() override { return hand_; }
  device::RemoteHand& hand() { return hand_; }
  void get_ready() override {}
  std::string text_for_operator() const override { return hand_.text(); }
  std::optional<device::LatenessCount> round_trip() const override { return round_trip_; }
  std::string release() const override { return release_; }
  // Throws DeviceError where a force might stay on if this program died.
  void try_release(const std::string& accepted_without) {
    release_ = described(hand_.release_after(tried_silence), accepted_without);
  }
  void measure_round_trip() { round_trip_ = hand_.round_trips(); }

 private:
  static std::string described(device::RemoteHand::Release release,
                               const std::string& accepted_without) {
    using enum device::RemoteHand::Release;
    if (release == released) {
      return fmt::format(
          "the other program reports that it released the force after {} ms without "
          "requests",
          tried_silence.count());
    }
    const std::string found = fault_of(release);
    if (release == always_reported || accepted_without.empty()) {
      throw device::DeviceError{fmt::format(
          "remote: {}{}", found,
          release == always_reported
              ? ""
              : "; if it lets go all the same, say in the rig how this was found and who answers "
                "for it (remote: {accepted_without_release: …})")};
    }
    return fmt::format("{}; according to the rig: {}", found, accepted_without);
  }
  static std::string fault_of(device::RemoteHand::Release release) {
    using enum device::RemoteHand::Release;
    switch (release) {
      case held:
        return fmt::format(
            "the other program did not release the force after {} ms without requests",
            tried_silence.count());
      case always_reported:
        return "the other program reports a released force in every reply: it must report it only "
               "after a silence (device/remote/README.md)";
      case not_reported:
        return "the other program does not report whether it releases the force when requests stop "
               "(version 1 of the protocol cannot)";
      case released:
        break;
    }
    return {};
  }

  SessionLock lock_;
  device::RemoteHand hand_;
  std::string release_;
  std::optional<device::LatenessCount> round_trip_;
};

// Throws InvalidInput if the rig, or the protocol, asks for more than the device can do.
void refuse_beyond(const device::RemoteDescription& device, const DeviceRequest& request,
                   double max_sample_age_s) {
  const auto refuse = [&](bool is_refused, const char* asked, double value, const char* unit,
                          double allowed, const char* remedy) {
    if (is_refused) {
      throw core::InvalidInput{
          fmt::format("remote: {}: {:.6g} {} asked, {:.6g} {} by what '{}' "
                      "says of itself ({})",
                      asked, value, unit, allowed, unit, device.name, remedy)};
    }
  };
  const core::GateSettings& gate = request.rig.gate;
  const double stiffness_n_per_m = largest_contact_stiffness_n_per_m(request.protocol);
  refuse(gate.limits.max_force_n > device.max_force_n, "max_force_n", gate.limits.max_force_n, "N",
         device.max_force_n, "lower it in the rig");
  refuse(gate.workspace_radius_m > device.workspace_radius_m, "workspace_radius_m",
         gate.workspace_radius_m, "m", device.workspace_radius_m, "lower it in the rig");
  refuse(stiffness_n_per_m > device.max_stiffness_n_per_m, "stiffness of the contact",
         stiffness_n_per_m, "N/m", device.max_stiffness_n_per_m,
         "lower penalty_stiffness_n_per_m in the protocol");
  refuse(max_sample_age_s * device.rate_hz < 1.0, "max_sample_age_s", max_sample_age_s, "s",
         1.0 / device.rate_hz, "at least the time between two samples");
  refuse(device.driven_axes < 3, "driven axes", 3, "of force", device.driven_axes,
         "taps need a force along each");
}

// Said once a session.
std::string untold_by(int version) {
  constexpr const char* frozen =
      "does not number its samples: if the device stops measuring, this is noticed only under "
      "force, after up to 3 s";
  switch (version) {
    case 1:
      return fmt::format(
          "remote: version 1 of the protocol tells neither the force exerted, nor a "
          "release, and {}",
          frozen);
    case 2:
      return fmt::format("remote: version 2 of the protocol {}", frozen);
    default:
      return {};
  }
}

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
              section->max_sample_age_s = reader.number(
                  {"max_sample_age_s",
                   "an older position, or one whose sample number stands still for longer, is a "
                   "fault; version 3 of the protocol"},
                  {0.0005, 0.05}, section->max_sample_age_s);
              reader.refuse_former("delay_ticks", "force_delay_s, a time in seconds");
              if (reader.has("force_delay_s")) {
                section->force_delay_s = reader.number(
                    {"force_delay_s",
                     "time between the request of a force and its action, for the stability bound "
                     "that `check` prints; unset: a period of the loop"},
                    {0.0, 0.01});
              }
              section->accepted_without_release = reader.text(
                  {"accepted_without_release",
                   "for a program that does not report that it releases the force when requests "
                   "stop, and is refused otherwise: how it was found that it does, and who answers "
                   "for it; unset: such a program is refused"},
                  "");
            });
    return section;
  }
  double force_delay_s(const protocols::Rig& rig, double period_s) const override {
    return dynamic_cast<const RemoteSection&>(*rig.section).force_delay_s.value_or(period_s);
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
    const auto& section = dynamic_cast<const RemoteSection&>(*rig.section);
    RemoteDevice opened{section};
    opened.try_release(section.accepted_without_release);
    return opened.release();
  }
  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    const auto& section = dynamic_cast<const RemoteSection&>(*request.rig.section);
    auto opened = std::make_unique<RemoteDevice>(section);
    if (const auto& introduction = opened->hand().introduction()) {
      refuse_beyond(*introduction, request, section.max_sample_age_s);
    } else {
      warn(untold_by(opened->hand().version()));
    }
    opened->try_release(section.accepted_without_release);
    opened->measure_round_trip();
    return opened;
  }
};
}  // namespace

const DeviceKind& remote_device() {
  static const RemoteKind kind;
  return kind;
}
}  // namespace tapstudy::runner
