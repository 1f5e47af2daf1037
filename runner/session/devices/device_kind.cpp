#include "runner/session/devices/device_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "protocols/yaml/yaml_reader.hpp"
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

double read_max_reply_s(protocols::MapReader& section, double usual_s) {
  return section.number({"max_reply_s",
                         "a reply that takes longer is missing; none for more than 0.01 s, or for "
                         "a tenth of the time "
                         "in the long run, is a fault; at most half of loop.max_stall_s"},
                        {0.0001, 0.05}, usual_s);
}

std::unique_ptr<SessionDevice> reconnect(const std::string& what_happened,
                                         const DeviceRequest& request,
                                         std::unique_ptr<SessionDevice> broken) {
  const device::DeviceError gives_up{what_happened + " (go on with --resume)"};
  const std::string text = broken ? broken->text_for_operator() : std::string{};
  if (!request.rig.has_hardware) {
    throw gives_up;
  }
  const DeviceKind& kind = kind_of(request.rig);
  std::string task = fmt::format("{}.\n{}Check the device, its power and cable.", what_happened,
                                 text.empty() ? text : fmt::format("The device says: {}\n", text));
  while (request.ask_operator(task)) {
    task = "It is not there yet. Check its power and cable.";
    if (!kind.is_there()) {
      continue;
    }
    broken.reset();  // only one can hold the device, and its guardian may have repeated zero force
    try {
      return kind.open(request);
    } catch (const device::DeviceError& error) {  // enumerated, but not ready, or still held
      task = fmt::format("{}. Check the device.", error.what());
    }
  }
  throw gives_up;
}
}  // namespace tapstudy::runner
