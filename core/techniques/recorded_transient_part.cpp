#include "core/techniques/compensated.hpp"
#include "core/techniques/force_part.hpp"
#include "core/techniques/resampled.hpp"
#include "core/tick/recorded_transient.hpp"
namespace tapstudy::core {
const ForcePart recorded_transient{
    false,
    [](const RenderSettings& settings) -> std::string_view {
      return settings.recorded_taps ? "" : "a recording of the stimulus";
    },
    [](const RenderSettings& settings,
       const VibratingPlate* /*plate*/) -> std::unique_ptr<AddedForce> {
      std::vector<RecordedTap> taps = settings.recorded_taps->taps;
      const double rate_hz = 1.0 / settings.dt_s;
      for (RecordedTap& tap : taps) {
        tap.force_n = resampled(tap.force_n, settings.recorded_taps->rate_hz, rate_hz);
        if (settings.device_response) {
          tap.force_n = compensated(tap.force_n, *settings.device_response, rate_hz);
        }
      }
      return std::make_unique<RecordedTransient>(std::move(taps), settings.vibration_gain);
    },
    nullptr};
}  // namespace tapstudy::core
