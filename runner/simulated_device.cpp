#include <utility>

#include "runner/session_device.hpp"
#include "runner/simulated/tap_drawing.hpp"
namespace tapstudy::runner {
namespace {
constexpr int taps_without_end = 2000;

class SimulatedDevice final : public SessionDevice {
 public:
  SimulatedDevice(const protocols::Protocol& protocol, core::Placement placement,
                  std::uint64_t seed)
      : protocol_{protocol},
        placement_{std::move(placement)},
        rng_{seed},
        hand_{hand_body(protocol.simulation.hand), protocol.rendering.dt_s,
              device::SimulatedHand::Memory::none} {}
  device::Device& device() override { return hand_; }
  void get_ready() override {
    hand_.follow(draw_taps(protocol_, placement_, taps_without_end, rng_));
  }

 private:
  const protocols::Protocol& protocol_;
  core::Placement placement_;
  core::Rng rng_;
  device::SimulatedHand hand_;
};
}  // namespace

std::unique_ptr<SessionDevice> simulated_device(const protocols::Protocol& protocol,
                                                const core::Placement& placement,
                                                std::uint64_t seed) {
  return std::make_unique<SimulatedDevice>(protocol, placement, seed);
}
}  // namespace tapstudy::runner
