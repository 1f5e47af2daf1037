#include "core/techniques/force_part.hpp"
#include "core/tick/plate_vibration.hpp"
namespace tapstudy::core {
const ForcePart plate_vibration{
    true, [](const RenderSettings& /*settings*/) { return std::string_view{}; },
    [](const RenderSettings& settings, const VibratingPlate* plate) -> std::unique_ptr<AddedForce> {
      return std::make_unique<PlateVibration>(*plate, settings);
    },
    nullptr};
}  // namespace tapstudy::core
