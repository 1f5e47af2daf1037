#include "device/hand/simulated_hand.hpp"

#include "core/random/rng.hpp"
#include "runner/session/devices/device_kind.hpp"
#include "runner/session/participants/planned_taps.hpp"
namespace tapstudy::runner {
namespace {
constexpr int taps_without_end = 2000;
constexpr const char* kind_name = "simulated_hand";

class SimulatedDevice final : public SessionDevice {
 public:
  SimulatedDevice(const protocols::Protocol& protocol, const protocols::Rig& rig)
      : protocol_{protocol},
        placement_{rig.placement.value_or(protocol.placement)},
        hand_{protocol.simulation.hand, protocol.rendering.dt_s,
              device::SimulatedHand::Memory::none} {}
  device::Device& device() override { return hand_; }
  std::string description() override { return kind_name; }
  void begin_session(std::uint64_t seed) override {
    rng_ = core::Rng{core::derived_seed(seed, core::Purpose::hand)};
  }
  void get_ready() override {
    hand_.follow(
        draw_taps(protocol_, protocol_.simulation.taps, placement_, taps_without_end, rng_));
  }

 private:
  const protocols::Protocol& protocol_;
  core::Placement placement_;
  core::Rng rng_{0};
  device::SimulatedHand hand_;
};

class SimulatedHandKind final : public DeviceKind {
 public:
  std::string_view name() const override { return kind_name; }
  bool has_hardware() const override { return false; }
  bool has_participant() const override { return false; }
  std::shared_ptr<const protocols::DeviceSection> read_section(
      protocols::MapReader& /*top*/, const protocols::RigText& /*rig*/) const override {
    return nullptr;
  }
  std::unique_ptr<SessionDevice> open(const DeviceRequest& request) const override {
    return std::make_unique<SimulatedDevice>(request.protocol, request.rig);
  }
};
}  // namespace

const DeviceKind& simulated_hand() {
  static const SimulatedHandKind kind;
  return kind;
}
}  // namespace tapstudy::runner
