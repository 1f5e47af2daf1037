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
      for (RecordedTap& tap : taps) {
        tap.force_n = resampled(tap.force_n, settings.recorded_taps->rate_hz, 1.0 / settings.dt_s);
      }
      return std::make_unique<RecordedTransient>(std::move(taps), settings.vibration_gain);
    },
    nullptr};
}  // namespace tapstudy::core
