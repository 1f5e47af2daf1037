#include "core/techniques/divided_recording.hpp"
#include "core/techniques/technique.hpp"
#include "core/tick/impact_transients.hpp"
#include "core/tick/plate_vibration.hpp"
namespace tapstudy::core {
const ForcePart plate_vibration{
    true, [](const RenderSettings& /*settings*/) { return std::string_view{}; },
    [](const RenderSettings& settings, const VibratingPlate* plate) -> std::unique_ptr<AddedForce> {
      return std::make_unique<PlateVibration>(*plate, settings);
    }};

const ForcePart coupled_vibration{
    true,
    [](const RenderSettings& settings) -> std::string_view {
      if (settings.finger.mass_kg <= 0.0) {
        return "finger.mass_kg above 0";
      }
      if (settings.crossover) {
        return "rendering without crossover_hz: its finger acts on all modes at once";
      }
      return settings.finger.stiffness_n_per_m > 0.0 ? "" : "finger.stiffness_n_per_m above 0";
    },
    [](const RenderSettings& settings, const VibratingPlate* plate) -> std::unique_ptr<AddedForce> {
      return std::make_unique<CoupledVibration>(*plate, settings);
    }};

const ForcePart decaying_sinusoid{
    false,
    [](const RenderSettings& settings) -> std::string_view {
      return settings.sinusoid.amplitude_n_s_per_m > 0.0
                 ? ""
                 : "rendering.sinusoid with an amplitude above 0";
    },
    [](const RenderSettings& settings,
       const VibratingPlate* /*plate*/) -> std::unique_ptr<AddedForce> {
      SinusoidShape shape = settings.sinusoid;
      if (settings.crossover) {
        shape.amplitude_n_s_per_m *= 1.0 - settings.crossover->actuator_share(shape.frequency_hz);
      }
      return std::make_unique<DecayingSinusoid>(shape, settings.dt_s);
    }};

const ForcePart recorded_transient{
    false,
    [](const RenderSettings& settings) -> std::string_view {
      return settings.recorded_taps ? "" : "a recording of the stimulus";
    },
    [](const RenderSettings& settings,
       const VibratingPlate* /*plate*/) -> std::unique_ptr<AddedForce> {
      return std::make_unique<RecordedTransient>(recorded_by(
          RenderedBy::device, settings, settings.device_response.get(), 1.0 / settings.dt_s));
    }};
}  // namespace tapstudy::core
