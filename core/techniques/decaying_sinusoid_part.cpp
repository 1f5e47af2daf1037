#include "core/techniques/force_part.hpp"
#include "core/tick/decaying_sinusoid.hpp"
namespace tapstudy::core {
const ForcePart decaying_sinusoid{
    false,
    [](const RenderSettings& settings) -> std::string_view {
      return settings.sinusoid.amplitude_n_s_per_m > 0.0
                 ? ""
                 : "rendering.sinusoid with an amplitude above 0";
    },
    [](const RenderSettings& settings, const VibratingPlate* /*plate*/)
        -> std::unique_ptr<AddedForce> { return std::make_unique<DecayingSinusoid>(settings); },
    nullptr};
}  // namespace tapstudy::core
