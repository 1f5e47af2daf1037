#include "core/techniques/force_part.hpp"
#include "core/tick/coupled_vibration.hpp"
namespace tapstudy::core {
const ForcePart coupled_vibration{
    true,
    [](const RenderSettings& settings) -> std::string_view {
      if (settings.finger.mass_kg <= 0.0) {
        return "finger.mass_kg above 0";
      }
      return settings.finger.stiffness_n_per_m > 0.0 ? "" : "finger.stiffness_n_per_m above 0";
    },
    [](const RenderSettings& settings, const VibratingPlate* plate) -> std::unique_ptr<AddedForce> {
      return std::make_unique<CoupledVibration>(*plate, settings);
    },
    // the pad, as stiff as the contact spring, in series with the finger's spring
    [](const RenderSettings& settings) {
      const double pad = settings.penalty_stiffness_n_per_m;
      const double finger = settings.finger.stiffness_n_per_m;
      return pad * finger / (pad + finger);
    }};
}  // namespace tapstudy::core
