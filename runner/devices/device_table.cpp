#include <algorithm>

#include "core/error.hpp"
#include "runner/devices/shipped_devices.hpp"
namespace tapstudy::runner {
const std::vector<const DeviceKind*>& device_kinds() {
  static const std::vector<const DeviceKind*> table{&simulated_hand(), &spidar_g6(),
                                                    &remote_device(), &replayed_hand()};
  return table;
}

const DeviceKind& kind_of(const protocols::Rig& rig) {
  const auto found =
      std::ranges::find(device_kinds(), std::string_view{rig.device}, &DeviceKind::name);
  if (found == device_kinds().end()) {
    throw core::InvalidInput{"rig: device: '" + rig.device + "' is not a known device"};
  }
  return **found;
}
}  // namespace tapstudy::runner
